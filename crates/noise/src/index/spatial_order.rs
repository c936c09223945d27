//! An order in which points that follow one another are near one another.

use cloudtouch_geom::Point3;
use rayon::prelude::*;

use crate::finite::is_finite;
use crate::index::octree::Octree;

/// What a function makes of every point, by its index, on all threads of the pool. It is called for
/// points near one another in turn, with buffers that may keep what they have in common.
pub(crate) fn in_spatial_order<B: Default, T: Send + Copy>(
    points: &[Point3],
    of: impl Fn(usize, &mut B) -> T + Sync,
) -> Vec<T> {
    let order = spatial_order(points);
    let made: Vec<T> = order
        .par_iter()
        .map_init(B::default, |buffers, &index| of(index as usize, buffers))
        .collect();
    let mut places = vec![0; order.len()];
    for (place, &index) in order.iter().enumerate() {
        places[index as usize] = place;
    }
    places.into_iter().map(|place| made[place]).collect()
}

/// The indices of points in the order of the cells of an octree; those that are not finite come first.
fn spatial_order(points: &[Point3]) -> Vec<u32> {
    let all = 0..points.len() as u32;
    let (finite, mut order): (Vec<u32>, Vec<u32>) =
        all.partition(|&index| is_finite(&points[index as usize]));
    order.extend(Octree::of(points, &finite).indices());
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_comes_once_and_neighbours_follow() {
        let mut points: Vec<Point3> = (0..4096)
            .map(|i| Point3::new(f64::from(i * 37 % 64), f64::from(i / 64), 5.0))
            .collect();
        points[17] = Point3::new(f64::NAN, 0.0, 0.0);
        let mut order = spatial_order(&points);
        let steps = order.windows(2).map(|pair| {
            let [p, q] = [pair[0], pair[1]].map(|i| points[i as usize]);
            (p - q).norm()
        });
        let long = steps.filter(|step| step.is_nan() || *step >= 8.0).count();
        assert!(long < 100, "{long} long steps");
        order.sort_unstable();
        assert!(order.into_iter().eq(0..4096));
        let same = in_spatial_order(&points, |index, (): &mut ()| index);
        assert!(same.into_iter().eq(0..4096));
        assert!(spatial_order(&[]).is_empty());
    }
}
