//! A point known up to a normal distribution.

use crate::covariance::Covariance;
use crate::pose::Pose;
use crate::vectors::Point3;

/// An unknown surface point x' ~ N(`mean`, `covariance`), in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UncertainPoint {
    /// Where the surface point is expected.
    pub mean: Point3,
    /// How far it may be from there, in the same frame.
    pub covariance: Covariance,
}

impl UncertainPoint {
    /// A point known exactly, such as a vertex of a mesh.
    pub fn exact(mean: Point3) -> Self {
        Self { mean, covariance: Covariance::zero() }
    }

    /// The same point seen from another frame.
    #[must_use]
    pub fn transformed(&self, pose: &Pose) -> Self {
        Self {
            mean: pose.transform_point(&self.mean),
            covariance: self.covariance.rotated(pose.rotation()),
        }
    }
}
