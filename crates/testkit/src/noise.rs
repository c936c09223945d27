//! Noise on points, by named distributions.

use cloudtouch_geom::{Point3, Vector3, seed};
use rand::Rng;
use rand_distr::{ChiSquared, Distribution};

use crate::random::normal_vector;

/// How the error along each axis is distributed; always with mean zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoiseKind {
    /// Normal.
    Gaussian,
    /// Student's t with three degrees of freedom, scaled to the standard deviation asked for; the
    /// axes share one scale, so that bad points are bad in every direction.
    ///
    /// Beyond three standard deviations it has 1.4 % of the errors, the normal 0.27 %.
    HeavyTailed,
}

/// The points, each displaced by independent errors with standard deviation `std` metres per axis.
pub fn add_noise(points: &[Point3], kind: NoiseKind, std: f64, seed: u64) -> Vec<Point3> {
    let mut rng = seed::generator(seed);
    points.iter().map(|p| p + unit_error(kind, &mut rng) * std).collect()
}

/// An error with standard deviation 1 along every axis.
pub(crate) fn unit_error(kind: NoiseKind, rng: &mut impl Rng) -> Vector3 {
    let normal = normal_vector(rng);
    match kind {
        NoiseKind::Gaussian => normal,
        NoiseKind::HeavyTailed => {
            let chi_squared =
                ChiSquared::new(3.0_f64).expect("three degrees of freedom are allowed");
            // t₃ = normal / √(χ²₃ / 3) has variance 3, hence normal / √χ²₃ has variance 1.
            normal / chi_squared.sample(rng).sqrt()
        }
    }
}
