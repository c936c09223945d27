//! Bodies that move or bend between the scan and the query (section 3 of the paper): what that adds
//! to the position noise of their points.

use cloudtouch_geom::{Covariance, Matrix3, Point3, Vector3};

use crate::error::NoiseError;
use crate::settings_error::check_not_negative;

/// How well the place of a moving or bending body is known, in the frame of its cloud.
///
/// To first order in the turn: a point at p gets T + \[p−c\]ₓ R \[p−c\]ₓᵀ + d² I beside its Σ, with T
/// and R diagonal. Each point is treated on its own: that all move together is not said.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct MotionNoise {
    /// Standard deviations of the translation along x, y and z, m.
    pub translation_std: [f64; 3],
    /// Standard deviations of the turns about x, y and z, rad.
    pub rotation_std: [f64; 3],
    /// c, the point that the body turns about, m.
    pub about: [f64; 3],
    /// d: how far the surface bends in any direction, as a standard deviation, m.
    pub deformation_std: f64,
}

impl MotionNoise {
    /// Checks the values.
    ///
    /// # Errors
    /// When a standard deviation is negative or a value is not finite.
    pub fn validate(&self) -> Result<(), NoiseError> {
        let not_negative = |name, values: &[f64]| {
            values.iter().try_for_each(|&value| check_not_negative(name, value))
        };
        not_negative("motion.translation_std", &self.translation_std)?;
        not_negative("motion.rotation_std", &self.rotation_std)?;
        not_negative("motion.deformation_std", &[self.deformation_std])?;
        // Of either sign, so long as it is finite.
        not_negative("motion.about", &self.about.map(f64::abs))?;
        Ok(())
    }

    /// What the motion adds to Σ of a point at `place`, m and m².
    pub fn covariance(&self, place: &Point3) -> Covariance {
        let squared = |stds: [f64; 3]| Matrix3::from_diagonal(&stds.map(|s| s * s).into());
        let lever = (place.coords - Vector3::from(self.about)).cross_matrix();
        let turned = lever * squared(self.rotation_std) * lever.transpose();
        let bent = Matrix3::from_diagonal_element(self.deformation_std.powi(2));
        Covariance::from_symmetric(&(squared(self.translation_std) + turned + bent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_moves_far_points_across_their_lever() {
        let about = [1.0, 0.0, 0.0];
        let motion =
            MotionNoise { rotation_std: [0.0, 0.0, 0.01], about, ..MotionNoise::default() };
        let std = |place: Point3, along: Vector3| motion.covariance(&place).std_along(&along);
        // Half a metre from the axis: 5 mm about it, nothing towards it or along it.
        let place = Point3::new(1.5, 0.0, 0.3);
        assert!((std(place, Vector3::y()) - 0.005).abs() < 1e-15);
        assert!(std(place, Vector3::x()) < 1e-15 && std(place, Vector3::z()) < 1e-15);
        let shift = MotionNoise {
            translation_std: [0.003, 0.0, 0.0],
            deformation_std: 0.004,
            ..MotionNoise::default()
        };
        let found = shift.covariance(&place);
        assert!((found.std_along(&Vector3::x()) - 0.005).abs() < 1e-15);
        assert!((found.std_along(&Vector3::z()) - 0.004).abs() < 1e-15);
    }

    #[test]
    fn values_out_of_range_are_refused() {
        let usual = MotionNoise::default();
        assert_eq!(usual.validate(), Ok(()));
        assert!(MotionNoise { about: [-1.0; 3], ..usual }.validate().is_ok());
        for bad in [
            MotionNoise { translation_std: [0.0, -1e-3, 0.0], ..usual },
            MotionNoise { rotation_std: [f64::NAN; 3], ..usual },
            MotionNoise { about: [f64::INFINITY; 3], ..usual },
            MotionNoise { deformation_std: -1.0, ..usual },
        ] {
            // Not "of the sensor", which has none of these.
            let Err(NoiseError::Setting(error)) = bad.validate() else { panic!("{bad:?}") };
            assert!(error.name.starts_with("motion."), "{error}");
        }
    }
}
