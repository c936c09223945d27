//! The few random shapes the generators share.

use cloudtouch_geom::Vector3;
use nalgebra::{Quaternion, UnitQuaternion};
use rand::{Rng, RngExt};
use rand_distr::{Distribution, StandardNormal};

/// Three independent standard normal values.
pub(crate) fn normal_vector(rng: &mut impl Rng) -> Vector3 {
    Vector3::from_fn(|_, _| StandardNormal.sample(rng))
}

/// A rotation, every one equally likely; no trigonometry, so equal on every platform.
pub(crate) fn rotation(rng: &mut impl Rng) -> UnitQuaternion<f64> {
    let v = normal_vector(rng);
    UnitQuaternion::from_quaternion(Quaternion::new(StandardNormal.sample(rng), v.x, v.y, v.z))
}

/// A unit vector, every direction equally likely.
pub(crate) fn direction(rng: &mut impl Rng) -> Vector3 {
    // A vector of length zero has probability zero; any direction will do for it.
    normal_vector(rng).try_normalize(0.0).unwrap_or_else(Vector3::x)
}

/// A unit vector less than `angle` radians off `axis`; not uniform in the cone.
pub(crate) fn direction_near(axis: &Vector3, angle: f64, rng: &mut impl Rng) -> Vector3 {
    small_rotation(angle, rng) * axis.normalize()
}

/// A turn by less than `angle` radians about a random axis.
pub(crate) fn small_rotation(angle: f64, rng: &mut impl Rng) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(direction(rng) * between(0.0, angle, rng))
}

/// A number in [low, high), every one equally likely.
pub(crate) fn between(low: f64, high: f64, rng: &mut impl Rng) -> f64 {
    low + (high - low) * rng.random::<f64>()
}

/// A number at most `half` from zero.
pub(crate) fn within(half: f64, rng: &mut impl Rng) -> f64 {
    between(-half, half, rng)
}
