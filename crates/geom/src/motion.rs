//! A pose made ready to move many points.

use crate::covariance::Covariance;
use crate::pose::Pose;
use crate::uncertain::UncertainPoint;
use crate::vectors::{Matrix3, Point3, Vector3};

/// A rigid motion p ↦ R p + t with R as a matrix: what a [`Pose`] does, several times as fast once
/// there are more than a few points to move.
///
/// ```
/// use cloudtouch_geom::{Motion, Point3, Pose, Vector3};
/// let pose = Pose::from_translation_rpy(Vector3::new(1.0, 2.0, 3.0), [0.1, 0.2, 0.3]);
/// let point = Point3::new(0.4, 0.5, 0.6);
/// let moved = Motion::from(&pose).point(&point);
/// assert!((moved - pose.transform_point(&point)).norm() < 1e-15);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    rotation: Matrix3,
    translation: Vector3,
}

impl From<&Pose> for Motion {
    fn from(pose: &Pose) -> Self {
        let rotation = pose.rotation().to_rotation_matrix().into_inner();
        Self { rotation, translation: pose.translation() }
    }
}

impl Motion {
    /// R.
    pub fn rotation(&self) -> &Matrix3 {
        &self.rotation
    }

    /// R p + t.
    #[inline]
    pub fn point(&self, point: &Point3) -> Point3 {
        Point3::from(self.rotation * point.coords + self.translation)
    }

    /// R⁻¹ (p − t).
    #[inline]
    pub fn point_back(&self, point: &Point3) -> Point3 {
        Point3::from(self.rotation.tr_mul(&(point.coords - self.translation)))
    }

    /// R v.
    #[inline]
    pub fn vector(&self, vector: &Vector3) -> Vector3 {
        self.rotation * vector
    }

    /// R⁻¹ v.
    #[inline]
    pub fn vector_back(&self, vector: &Vector3) -> Vector3 {
        self.rotation.tr_mul(vector)
    }

    /// R Σ Rᵀ.
    #[inline]
    pub fn covariance(&self, covariance: &Covariance) -> Covariance {
        covariance.turned(&self.rotation)
    }

    /// Both of a point.
    #[inline]
    pub fn uncertain_point(&self, point: &UncertainPoint) -> UncertainPoint {
        UncertainPoint {
            mean: self.point(&point.mean),
            covariance: self.covariance(&point.covariance),
        }
    }
}
