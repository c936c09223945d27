//! Leaf problems: two small clouds with a known gap.

use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint, Vector3, seed};
use cloudtouch_svm::{Class, Sample};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};

/// What stands over the plane.
pub(super) const SHAPES: [&str; 3] = ["cap", "wedge", "sheet"];

/// A shape of [`SHAPES`] over a square plane of side 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Leaf {
    /// Its number.
    pub(super) shape: usize,
    /// How far its lowest place is above the plane; negative in overlap.
    pub(super) gap: f64,
    /// Standard deviation of the noise along each axis.
    pub(super) std: Vector3,
}

impl Leaf {
    /// So many measured points of the shape, and as many of the plane.
    pub(super) fn clouds(&self, per_side: usize, from: u64) -> [Vec<UncertainPoint>; 2] {
        let variances = self.std.component_mul(&self.std);
        let covariance = Covariance::from_symmetric(&Matrix3::from_diagonal(&variances));
        [0, 1].map(|side| {
            let at = |i: u64| {
                let draw = |k| seed::unit(seed::derive(seed::derive(from, 1, side), i, k)) - 0.5;
                let (x, y) = (draw(0), draw(1));
                let above = match self.shape {
                    0 => 0.6 * (x * x + y * y),
                    1 => 0.8 * x.abs(),
                    _ => 0.4 * (x + 0.5),
                };
                Point3::new(x, y, if side == 0 { self.gap + above } else { 0.0 })
            };
            let exact: Vec<Point3> = (0..per_side as u64).map(at).collect();
            let moved = add_noise(&exact, NoiseKind::Gaussian, 1.0, seed::derive(from, 2, side));
            let errors = exact.iter().zip(moved).map(|(p, q)| (q - p).component_mul(&self.std));
            let means = exact.iter().zip(errors).map(|(p, error)| p + error);
            means.map(|mean| UncertainPoint { mean, covariance }).collect()
        })
    }
}

/// The points of both sides as samples of a radius (r) and a penalty (C).
pub(super) fn samples(sides: [Vec<UncertainPoint>; 2], radius: f64, penalty: f64) -> Vec<Sample> {
    let of = |(points, class): (Vec<UncertainPoint>, Class)| {
        points.into_iter().map(move |point| Sample { point, class, radius, penalty })
    };
    sides.into_iter().zip([Class::A, Class::B]).flat_map(of).collect()
}
