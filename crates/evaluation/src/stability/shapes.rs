//! Pairs of small clouds with a known gap, and what may be done to them.

use cloudtouch_geom::{Covariance, Matrix3, Point3, Pose, UncertainPoint, Vector3, seed};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};

use super::sheet::SEED;

/// Shapes over a plane, each with equal noise, then each with lopsided noise.
pub(super) const KINDS: u64 = 6;

/// Two clouds in one frame.
pub(super) type Clouds = [Vec<UncertainPoint>; 2];

/// A cap, a wedge or a slanted sheet over a square plane of side 1, that far from it, measured with
/// noise of `std` at so many points each.
pub(super) fn clouds(points: u64, gap: f64, std: f64, kind: u64) -> Clouds {
    let lopsided = kind >= KINDS / 2;
    [0, 1].map(|side| {
        let at = |i| {
            let draw = |k| seed::unit(seed::derive(seed::derive(SEED, kind, side), i, k)) - 0.5;
            let (x, y) = (draw(0), draw(1));
            let z = match (side, kind % 3) {
                (1, _) => 0.0,
                (_, 0) => gap + 0.6 * (x * x + y * y),
                (_, 1) => gap + 0.8 * x.abs(),
                _ => gap + 0.4 * (x + 0.5),
            };
            Point3::new(x, y, z)
        };
        let exact: Vec<Point3> = (0..points).map(at).collect();
        let noisy = add_noise(&exact, NoiseKind::Gaussian, 1.0, seed::derive(SEED, kind, 2 + side));
        let root = if lopsided { Vector3::new(0.2, 0.5, 1.0) } else { Vector3::repeat(1.0) } * std;
        let covariance = Matrix3::from_diagonal(&root.component_mul(&root));
        let errors = exact.iter().zip(&noisy).map(|(exact, noisy)| noisy - exact);
        let measured = exact.iter().zip(errors).map(|(p, error)| p + error.component_mul(&root));
        uncertain(&measured.collect::<Vec<_>>(), &vec![covariance; exact.len()])
    })
}

/// Points with a covariance each.
pub(super) fn uncertain(points: &[Point3], covariances: &[Matrix3]) -> Vec<UncertainPoint> {
    let covariances = covariances.iter().map(Covariance::from_symmetric);
    let both = points.iter().zip(covariances);
    both.map(|(&mean, covariance)| UncertainPoint { mean, covariance }).collect()
}

/// Scaled, then moved and turned, covariances along.
pub(super) fn placed(clouds: &Clouds, pose: &Pose, scale: f64) -> Clouds {
    let place = |p: &UncertainPoint| UncertainPoint {
        mean: pose.transform_point(&(p.mean * scale)),
        covariance: p.covariance.scaled(scale).rotated(pose.rotation()),
    };
    clouds.each_ref().map(|cloud| cloud.iter().map(place).collect())
}
