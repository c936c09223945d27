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
    /// How much of its variance along the normal is an error that its neighbours share, from 0 to 1: noise that is
    /// stated and does not scatter them, as the cells of a grid are off a wall along it.
    pub shared: f64,
}

/// How far refinement can go, without looking at neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// An upper bound on the distance between measured point and refined mean, m.
    pub shift: f64,
    /// An upper bound on the refined standard deviation in any direction, m.
    pub std: f64,
}
