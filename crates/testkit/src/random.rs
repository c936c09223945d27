//! The few random shapes the generators share.

use cloudtouch_geom::Vector3;
use nalgebra::{Quaternion, UnitQuaternion};
use rand::Rng;
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
