//! How far along its surface noise displaced a point.

use cloudtouch_geom::{Covariance, Vector3};

use crate::surface::Surface;

/// A move by no more than this part of the deviation of the noise is not doubted.
const NOT_DOUBTED: f64 = 0.1;

/// How far along the surface a point was displaced, in the mean, m: the part there of Σ ∇ log f, f being how dense
/// the samples are (the formula of Tweedie: Robbins 1956; Efron 2011).
///
/// Noise with a direction was stated by who knows how much of it is across that. Noise without one may be all along
/// the rays of a camera: `possible`, the largest variance that noise along the surface can have, is asked for where
/// the point would move, and what was stated beyond that moves it by no more than a tenth of its deviation.
pub(super) fn displaced(
    surface: &Surface,
    noise: &Covariance,
    possible: impl FnOnce() -> f64,
) -> Vector3 {
    let Some(variance) = noise.isotropic_variance() else {
        let displaced = noise.matrix() * surface.score;
        return displaced - surface.normal.into_inner() * surface.normal.dot(&displaced);
    };
    let displaced = surface.score * variance;
    let not_doubted = NOT_DOUBTED * (variance / displaced.norm_squared()).sqrt();
    if not_doubted < 1.0 {
        displaced * (possible() / variance).clamp(not_doubted, 1.0)
    } else {
        displaced
    }
}
