//! What refinement makes of a measured point.

use cloudtouch_geom::{UncertainPoint, UnitVector3};

/// A surface point as the noise model knows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refined {
    /// Mean and covariance of the surface point, in the frame of the cloud.
    pub point: UncertainPoint,
    /// Local spacing of the samples, m: zero for a point alone, never above the cap.
    pub spacing: f64,
    /// Normal of the fitted surface, of either sign; `None` where none was fitted.
    pub normal: Option<UnitVector3>,
}

/// How far refinement can go, without looking at neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// An upper bound on the distance between measured point and refined mean, m.
    pub shift: f64,
    /// An upper bound on the refined standard deviation in any direction, m.
    pub std: f64,
}
