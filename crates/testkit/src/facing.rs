//! Two small patches of measured points that face one another, as the leaves of two clouds do.

use cloudtouch_geom::seed::{derive, unit};
use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint, Vector3};

use crate::noise::{NoiseKind, add_noise};

/// So many measured points of a cap, a wedge or a sheet, which of these follows from the seed, and as many of the
/// plane that is `gap` below its lowest place, or above where that is negative. In sides of the unit box about
/// the origin, with a standard deviation along each axis.
pub fn patches_over_a_plane(
    per_side: usize,
    gap: f64,
    std: &Vector3,
    seed: u64,
) -> [Vec<UncertainPoint>; 2] {
    let shape = (3.0 * unit(derive(seed, 0, 3))) as usize;
    let variances = Matrix3::from_diagonal(&std.component_mul(std));
    let covariance = Covariance::from_symmetric(&variances);
    [0, 1].map(|side| {
        let at = |i: u64| {
            let draw = |k| unit(derive(derive(seed, 1, side), i, k)) - 0.5;
            let (x, y) = (draw(0), draw(1));
            let above = match shape {
                0 => 0.6 * (x * x + y * y),
                1 => 0.8 * x.abs(),
                _ => 0.4 * (x + 0.5),
            };
            Point3::new(x, y, if side == 0 { gap + above } else { 0.0 })
        };
        let exact: Vec<Point3> = (0..per_side as u64).map(at).collect();
        let moved = add_noise(&exact, NoiseKind::Gaussian, 1.0, derive(seed, 2, side));
        let errors = exact.iter().zip(moved).map(|(p, q)| (q - p).component_mul(std));
        let means = exact.iter().zip(errors).map(|(p, error)| p + error);
        means.map(|mean| UncertainPoint { mean, covariance }).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_have_the_gap_and_the_noise_that_is_asked_for() {
        let (gap, std) = (0.2, Vector3::new(0.001, 0.002, 0.01));
        for seed in 0..6 {
            let [above, plane] = patches_over_a_plane(400, gap, &std, seed);
            let heights =
                |of: &[UncertainPoint]| -> Vec<f64> { of.iter().map(|p| p.mean.z).collect() };
            let lowest = heights(&above).into_iter().fold(f64::INFINITY, f64::min);
            assert!((gap - 0.05..gap + 0.03).contains(&lowest), "{lowest}");
            let squares: f64 = heights(&plane).iter().map(|z| z * z).sum();
            let scatter = (squares / 400.0).sqrt();
            assert!((0.8..1.2).contains(&(scatter / std.z)), "{scatter}");
            let stated = plane[0].covariance.variance_along(&Vector3::z()).sqrt();
            assert!((stated - std.z).abs() < 1e-12, "{stated}");
        }
    }
}
