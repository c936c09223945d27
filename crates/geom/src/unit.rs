//! Directions, checked when they come from outside.

use crate::message::number;
use crate::vectors::{UnitVector3, Vector3};

/// A vector that points nowhere.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "({}, {}, {}) has no direction: give finite components, not all of them zero",
    number(vector.x), number(vector.y), number(vector.z)
)]
pub struct UnitError {
    /// What was given.
    pub vector: Vector3,
}

/// The direction of a vector of any length.
///
/// # Errors
/// When the vector is zero, or a component is not finite.
///
/// ```
/// use cloudtouch_geom::{Vector3, unit};
/// assert_eq!(unit(&Vector3::new(0.0, 0.0, -1e200))?, -Vector3::z_axis());
/// assert!(unit(&Vector3::zeros()).is_err());
/// # Ok::<(), cloudtouch_geom::UnitError>(())
/// ```
pub fn unit(vector: &Vector3) -> Result<UnitVector3, UnitError> {
    let largest = vector.amax();
    if largest == 0.0 || !vector.iter().all(|component| component.is_finite()) {
        return Err(UnitError { vector: *vector });
    }
    // Scaled first: squares of 1e200 overflow, those of 1e-200 vanish.
    Ok(UnitVector3::new_normalize(vector / largest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_of_any_length_have_a_direction_and_others_are_refused() {
        for length in [1e-308, 1e-200, 0.3, 1e200, 1e308] {
            let found = unit(&(Vector3::new(0.6, 0.0, -0.8) * length)).unwrap();
            assert!((found.into_inner() - Vector3::new(0.6, 0.0, -0.8)).norm() < 1e-15, "{length}");
        }
        for bad in [[0.0; 3], [f64::NAN, 1.0, 0.0], [1.0, f64::INFINITY, 0.0]] {
            let error = unit(&Vector3::from(bad)).unwrap_err();
            assert!(error.to_string().contains("has no direction"), "{error}");
        }
    }
}
