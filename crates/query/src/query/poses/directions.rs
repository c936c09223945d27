//! Directions to look along.

use cloudtouch_geom::{Pose, Vector3};
use nalgebra::UnitQuaternion;

use super::gradient::PoseGradient;
use crate::spiral::direction;

/// How many directions stand for all.
const ALL: usize = 48;
/// Directions around another.
const AROUND: usize = 6;

/// Unit vectors spread evenly in all directions.
pub(super) fn sphere() -> impl Iterator<Item = Vector3> {
    (0..ALL).map(|k| direction(k, ALL))
}

/// The axes of the scene and of the object, both ways, in the frame of the scene.
pub(super) fn axes(scene_from_object: &Pose) -> impl Iterator<Item = Vector3> {
    (0..3).flat_map(move |k| {
        let axis = Vector3::ith(k, 1.0);
        let of_object = scene_from_object.transform_vector(&axis);
        [axis, -axis, of_object, -of_object]
    })
}

/// Where a gradient at a pose leads out of a collision, in the frame of the scene: by the probability, and by the
/// clearance where there is one. No unit vectors, and nothing where it is flat.
pub(super) fn downhill(
    gradient: &PoseGradient,
    scene_from_object: &Pose,
) -> impl Iterator<Item = Vector3> {
    let climb =
        |&[x, y, z, ..]: &[f64; 6]| scene_from_object.transform_vector(&Vector3::new(x, y, z));
    let clearance = gradient.clearance.as_ref().map(climb);
    std::iter::once(-climb(&gradient.log_odds)).chain(clearance)
}

/// Unit vectors at an angle from a unit vector, evenly around it.
pub(super) fn ring(axis: &Vector3, angle: f64) -> impl Iterator<Item = Vector3> {
    let across = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
    let tilted = UnitQuaternion::from_scaled_axis(across * angle) * axis;
    let axis = *axis;
    (0..AROUND).map(move |k| {
        let turn = std::f64::consts::TAU * k as f64 / AROUND as f64;
        UnitQuaternion::from_scaled_axis(axis * turn) * tilted
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn some_direction_is_near_to_any() {
        let all: Vec<Vector3> = sphere().collect();
        for other in
            ring(&Vector3::x(), 1.0).chain(ring(&Vector3::z(), 0.1)).chain(axes(&Pose::identity()))
        {
            assert!((other.norm() - 1.0).abs() < 1e-12);
            assert!(all.iter().any(|d| d.dot(&other) > 0.4_f64.cos()), "{other}");
        }
    }
}
