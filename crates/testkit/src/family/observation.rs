//! What an observation is.

use cloudtouch_geom::PointCloud;

use crate::surface::SurfaceSample;

/// One of the two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The body that stays.
    A,
    /// The body that moves.
    B,
}

/// A noisy cloud and what it was drawn from.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// The cloud in its body's frame.
    ///
    /// A depth image is organised, with NaN rows, and brings the covariances that its noise has
    /// (the error is along the ray, with a share of the depth that is known); the body's frame is
    /// then the camera's optical one. Other clouds have isotropic noise and no covariances.
    pub cloud: PointCloud,
    /// For each row of the cloud the point without noise, with its true normal; its triangle counts
    /// within what is seen, not within the body's mesh.
    ///
    /// `None` for a row without a return, and for a point of a veil, which is on no surface.
    pub truth: Vec<Option<SurfaceSample>>,
    /// The standard deviation along each axis, of a depth image that of the depth at 1 m; m.
    pub std: f64,
}
