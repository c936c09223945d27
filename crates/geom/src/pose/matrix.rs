//! Rigid motions from matrices, as files and programs hold them.

use nalgebra::{Matrix4, Rotation3, UnitQuaternion};

use super::error::{PoseError, ROUNDING};
use crate::vectors::{Matrix3, Vector3};

/// The nearest rigid motion to a homogeneous matrix that is one but for rounding: where it moves the origin, and
/// how it turns.
pub(super) fn rigid(m: &Matrix4<f64>) -> Result<(Vector3, UnitQuaternion<f64>), PoseError> {
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
    Ok((Vector3::new(m[(0, 3)], m[(1, 3)], m[(2, 3)]), rotation))
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

    /// How far the motion taken from a matrix is from it, with its entries rounded to so many digits.
    fn off_by(rotation: &Matrix3, digits: i32) -> f64 {
        let unit = 10_f64.powi(-digits);
        let rounded = rotation.map(|entry| (entry / unit).round() * unit);
        let (_, taken) = rigid(&rounded.to_homogeneous()).unwrap();
        (taken.to_rotation_matrix().matrix() - rotation).amax()
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
}
