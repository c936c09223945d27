//! Rigid motions from matrices, as files and programs hold them.

use nalgebra::{Isometry3, Matrix4, Rotation3, Translation3, UnitQuaternion};

use super::{Pose, PoseError};
use crate::vectors::Matrix3;

/// What counts as rounding in R Rᵀ = I: files often hold six to nine digits, and four may leave 1.7e-4.
pub(super) const ROUNDING: f64 = 2e-4;

impl Pose {
    /// Checks a homogeneous matrix and takes the nearest rigid motion.
    ///
    /// # Errors
    /// When an entry is not finite, the last row is not 0 0 0 1, or the rotation part scales,
    /// shears or mirrors by more than the rounding of a text file (2e-4: four digits).
    pub fn try_from_matrix(m: &Matrix4<f64>) -> Result<Self, PoseError> {
        for row in 0..4 {
            for column in 0..4 {
                let value = m[(row, column)];
                if !value.is_finite() {
                    return Err(PoseError::NotFinite { row, column, value });
                }
            }
        }
        let found = [m[(3, 0)], m[(3, 1)], m[(3, 2)], m[(3, 3)]];
        if found.iter().zip([0.0, 0.0, 0.0, 1.0]).any(|(f, e)| (f - e).abs() > 1e-9) {
            return Err(PoseError::LastRow { found });
        }
        let linear: Matrix3 = m.fixed_view::<3, 3>(0, 0).into();
        let error = (linear * linear.transpose() - Matrix3::identity()).amax();
        if error > ROUNDING {
            return Err(PoseError::NotOrthonormal { error });
        }
        let determinant = linear.determinant();
        if determinant < 0.0 {
            return Err(PoseError::Mirrored { determinant });
        }
        let rotation = Rotation3::from_matrix_unchecked(nearest_rotation(linear));
        let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
        let translation = Translation3::new(m[(0, 3)], m[(1, 3)], m[(2, 3)]);
        Ok(Self(Isometry3::from_parts(translation, rotation)))
    }
}

/// The rotation nearest to a matrix that is one but for rounding: Newton's iteration for its polar factor, which
/// squares what is missing at each step and leaves a rotation as it is, half turns too.
fn nearest_rotation(mut linear: Matrix3) -> Matrix3 {
    const STEPS: usize = 3;
    for _ in 0..STEPS {
        let Some(inverse) = linear.try_inverse() else { break };
        linear = 0.5 * (linear + inverse.transpose());
    }
    linear
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vectors::{Point3, Vector3};

    /// How far the motion taken from a matrix is from it, with its entries rounded to so many digits.
    fn off_by(rotation: &Matrix3, digits: i32) -> f64 {
        let unit = 10_f64.powi(-digits);
        let rounded = rotation.map(|entry| (entry / unit).round() * unit);
        let taken = Pose::try_from_matrix(&rounded.to_homogeneous()).unwrap();
        (taken.rotation().to_rotation_matrix().matrix() - rotation).amax()
    }

    #[test]
    fn half_turns_are_not_taken_for_other_rotations() {
        let about = |axis: Vector3, angle| *Rotation3::new(axis.normalize() * angle).matrix();
        let half = std::f64::consts::PI;
        let of_rows = |rows: [[f64; 3]; 3]| Matrix3::from_fn(|r, c| rows[r][c]);
        let turned = of_rows([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]);
        assert_eq!(off_by(&turned, 0), 0.0);
        for k in 0..720 {
            let yaw = about(Vector3::z(), f64::from(k) * half / 360.0);
            let aside = Vector3::new(f64::from(k % 7) - 3.0, 1.0, f64::from(k % 5) - 2.0);
            for flip in [Vector3::x(), Vector3::y(), aside] {
                for close in [0.0, 1e-12, 1e-7, 1e-3] {
                    let rotation = yaw * about(flip, half - close);
                    for digits in 4..17 {
                        let off = off_by(&rotation, digits);
                        assert!(off < 1.1 * 10_f64.powi(-digits) + 1e-14, "{k} {digits} {off}");
                    }
                }
            }
        }
    }

    #[test]
    fn all_rotations_that_exchange_axes_are_taken_as_they_are() {
        let signs = [1.0, -1.0];
        let mut count = 0;
        for axes in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            for code in 0..8 {
                let sign = |row: usize| signs[code >> row & 1];
                let matrix = Matrix3::from_fn(|r, c| if axes[r] == c { sign(r) } else { 0.0 });
                if matrix.determinant() > 0.0 {
                    assert!(off_by(&matrix, 0) < 1e-15, "{matrix}");
                    count += 1;
                }
            }
        }
        assert_eq!(count, 24);
    }

    #[test]
    fn takes_a_rounded_matrix_and_refuses_bad_ones() {
        let pose = Pose::from_translation_rpy(Vector3::new(1.0, 2.0, 3.0), [0.1, -0.4, 2.0]);
        let mut m = pose.isometry().to_homogeneous();
        m.apply(|v| *v = (*v * 1e6).round() / 1e6);
        let back = Pose::try_from_matrix(&m).unwrap();
        let p = Point3::new(0.3, -0.2, 0.9);
        assert!((back.transform_point(&p) - pose.transform_point(&p)).norm() < 1e-5);

        let scaled = m.map_with_location(|r, c, v| if r < 3 && c < 3 { 2.0 * v } else { v });
        assert!(matches!(Pose::try_from_matrix(&scaled), Err(PoseError::NotOrthonormal { .. })));
        let mirrored = m.map_with_location(|r, c, v| if r < 3 && c == 0 { -v } else { v });
        assert!(matches!(Pose::try_from_matrix(&mirrored), Err(PoseError::Mirrored { .. })));
        assert!(matches!(Pose::try_from_matrix(&m.transpose()), Err(PoseError::LastRow { .. })));
        // A scale along one axis, a shear, a rotation that is none, and a place that is nowhere; but
        // one far away is a place.
        for (row, column, value, is_fine) in [
            (1, 1, 1.01, false),
            (0, 2, 0.1, false),
            (0, 0, 0.0, false),
            (2, 3, f64::INFINITY, false),
            (0, 3, 1e9, true),
        ] {
            let mut changed = Matrix4::identity();
            changed[(row, column)] = value;
            assert_eq!(Pose::try_from_matrix(&changed).is_ok(), is_fine, "{row} {column} {value}");
        }
        m[(0, 3)] = f64::NAN;
        assert!(matches!(
            Pose::try_from_matrix(&m),
            Err(PoseError::NotFinite { row: 0, column: 3, .. })
        ));
    }
}
