//! The weights of coverage (section 5): how much surface a point stands for.

use std::f64::consts::PI;

use cloudtouch_noise::Neighborhoods;

/// w(xᵢ): the area of the sphere that reaches to the `neighbors`-th nearest other position, as a
/// disc, m²; to the farthest where there are fewer, and 0 where there is none.
pub(super) fn sphere_area(cloud: &Neighborhoods, index: usize, neighbors: usize) -> f64 {
    cloud.nearest(index, neighbors).last().map_or(0.0, |farthest| PI * farthest.squared_distance)
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Point3;

    use super::*;

    #[test]
    fn the_sphere_reaches_to_the_kth_neighbour() {
        let line = |xs: &[f64]| {
            Neighborhoods::new(xs.iter().map(|&x| Point3::new(x, 0.0, 0.0)).collect()).unwrap()
        };
        let cloud = line(&[0.0, 1.0, -2.0, 50.0]);
        assert!((sphere_area(&cloud, 0, 2) - PI * 4.0).abs() < 1e-12);
        // All there are.
        assert!((sphere_area(&cloud, 0, 12) - PI * 2500.0).abs() < 1e-9);
        assert_eq!(sphere_area(&line(&[1.0, 1.0]), 0, 12), 0.0);
    }
}
