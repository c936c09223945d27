//! Rigid motions, checked when they come from outside.

mod error;
mod matrix;

use nalgebra::{Isometry3, Matrix4, Quaternion, Translation3, UnitQuaternion};

pub use self::error::PoseError;
use self::matrix::rigid;
use crate::vectors::{Point3, Vector3};

/// A rigid motion that maps points of one frame into another: p ↦ R p + t.
///
/// Named for what it does, as in `scene_from_object`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pose(Isometry3<f64>);

/// How far from one the length of a quaternion may be.
const QUATERNION_ROUNDING: f64 = 1e-3;
/// How far products of many quaternions of length one may get from it by rounding.
const DRIFT: f64 = 1e-9;

impl Pose {
    /// The pose that changes nothing.
    pub fn identity() -> Self {
        Self(Isometry3::identity())
    }

    /// Moves by `offset` metres without turning.
    pub fn from_translation(offset: Vector3) -> Self {
        Self(Isometry3::from_parts(Translation3::from(offset), UnitQuaternion::identity()))
    }

    /// Turns by roll, pitch and yaw (radians about x, then y, then z of the fixed frame), then
    /// moves by `offset` metres.
    pub fn from_translation_rpy(offset: Vector3, [roll, pitch, yaw]: [f64; 3]) -> Self {
        Self(Isometry3::from_parts(
            Translation3::from(offset),
            UnitQuaternion::from_euler_angles(roll, pitch, yaw),
        ))
    }

    /// Turns by a unit quaternion, then moves by `offset` metres. Of one that is not of length one, as what
    /// is not checked or read with serde may be, the direction counts; one without any makes every entry of
    /// the rotation NaN, which what takes poses refuses.
    pub fn from_translation_rotation(offset: Vector3, rotation: UnitQuaternion<f64>) -> Self {
        // Products of many keep their bits.
        let is_unit = (rotation.norm() - 1.0).abs() < DRIFT;
        let rotation =
            if is_unit { rotation } else { UnitQuaternion::new_normalize(*rotation.quaternion()) };
        Self(Isometry3::from_parts(Translation3::from(offset), rotation))
    }

    /// Turns by the quaternion w + x i + y j + z k, then moves by `offset` metres.
    ///
    /// # Errors
    /// When its length differs from one by more than the rounding of a text file (1e-3).
    pub fn try_from_quaternion(offset: Vector3, wxyz: [f64; 4]) -> Result<Self, PoseError> {
        let [w, x, y, z] = wxyz;
        let quaternion = Quaternion::new(w, x, y, z);
        let length = quaternion.norm();
        let off = (length - 1.0).abs();
        let rotation = if off < 4.0 * f64::EPSILON {
            // Of length one already: its bits are kept.
            UnitQuaternion::new_unchecked(quaternion)
        } else if off < QUATERNION_ROUNDING {
            UnitQuaternion::new_normalize(quaternion)
        } else {
            return Err(PoseError::QuaternionLength { length });
        };
        Ok(Self::from_translation_rotation(offset, rotation))
    }

    /// Takes an isometry of nalgebra; its rotation as [`Self::from_translation_rotation`] does.
    pub fn from_isometry(isometry: Isometry3<f64>) -> Self {
        Self::from_translation_rotation(isometry.translation.vector, isometry.rotation)
    }

    /// Checks a homogeneous matrix and takes the nearest rigid motion.
    ///
    /// # Errors
    /// When an entry is not finite, the last row is not 0 0 0 1, or the rotation part scales,
    /// shears or mirrors by more than the rounding of a text file (2e-4: four digits).
    pub fn try_from_matrix(m: &Matrix4<f64>) -> Result<Self, PoseError> {
        let (offset, rotation) = rigid(m)?;
        Ok(Self(Isometry3::from_parts(Translation3::from(offset), rotation)))
    }

    /// The rotation.
    pub fn rotation(&self) -> &UnitQuaternion<f64> {
        &self.0.rotation
    }

    /// The translation, m.
    pub fn translation(&self) -> Vector3 {
        self.0.translation.vector
    }

    /// The underlying isometry.
    pub fn isometry(&self) -> &Isometry3<f64> {
        &self.0
    }

    /// An entry that is NaN or infinite, if there is one: constructors other than
    /// [`Self::try_from_matrix`] take numbers as they come.
    pub fn non_finite_entry(&self) -> Option<f64> {
        self.0.to_homogeneous().iter().copied().find(|value| !value.is_finite())
    }

    /// R p + t.
    pub fn transform_point(&self, point: &Point3) -> Point3 {
        self.0.transform_point(point)
    }

    /// R v.
    pub fn transform_vector(&self, vector: &Vector3) -> Vector3 {
        self.0.transform_vector(vector)
    }

    /// The motion back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self(self.0.inverse())
    }

    /// `self` after `first`: with `a_from_b` and `b_from_c`, `a_from_b.after(&b_from_c)` is
    /// `a_from_c`.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self(self.0 * first.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn quaternions_are_of_length_one() {
        let half_turn = Pose::try_from_quaternion(Vector3::zeros(), [0.0, 1.0, 0.0, 0.0]).unwrap();
        assert!((half_turn.transform_vector(&Vector3::z()) + Vector3::z()).norm() < 1e-15);
        for bad in [[0.0; 4], [1.0, 1.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0, 1.0]] {
            let pose = Pose::try_from_quaternion(Vector3::zeros(), bad);
            assert!(matches!(pose, Err(PoseError::QuaternionLength { .. })), "{bad:?}");
        }
    }

    /// Points were stretched, and a body that touched read free.
    #[test]
    fn rotations_that_are_no_unit_quaternions_are_made_one() {
        let turn = UnitQuaternion::from_euler_angles(0.3, -0.2, 1.0);
        let p = Point3::new(0.3, -0.2, 0.9);
        for length in [0.1, 0.99, 2.0, 1e10] {
            let stretched = UnitQuaternion::new_unchecked(*turn.quaternion() * length);
            let isometry = Isometry3::from_parts(Translation3::new(1.0, 0.0, 0.0), stretched);
            for pose in [
                Pose::from_isometry(isometry),
                Pose::from_translation_rotation(Vector3::x(), stretched),
            ] {
                let expected = turn.transform_point(&p) + Vector3::x();
                assert!((pose.transform_point(&p) - expected).norm() < 1e-12, "{length}");
            }
        }
        let nowhere = UnitQuaternion::new_unchecked(Quaternion::new(0.0, 0.0, 0.0, 0.0));
        let pose = Pose::from_translation_rotation(Vector3::x(), nowhere);
        assert!(pose.non_finite_entry().is_some());
        // What is one keeps its bits, rounded or not.
        let mut product = turn;
        for _ in 0..1000 {
            product = turn * product;
        }
        let kept = Pose::from_translation_rotation(Vector3::x(), product);
        assert_eq!(kept.rotation().quaternion().coords, product.quaternion().coords);
    }

    #[test]
    fn after_chains_frames() {
        let a_from_b = Pose::from_translation_rpy(Vector3::x(), [0.0, 0.0, 1.0]);
        let b_from_c = Pose::from_translation(Vector3::y());
        let p = Point3::new(0.5, 0.0, 0.25);
        let direct = a_from_b.after(&b_from_c).transform_point(&p);
        let stepwise = a_from_b.transform_point(&b_from_c.transform_point(&p));
        assert!((direct - stepwise).norm() < 1e-15);
    }
}
