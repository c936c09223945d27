#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod bounding_box;
mod cloud;
mod covariance;
mod drift;
#[cfg(feature = "mesh")]
mod mesh;
pub mod message;
mod motion;
pub mod normal;
mod pose;
#[cfg(feature = "seed")]
pub mod seed;
mod uncertain;
mod unit;
mod vectors;

/// The library of whose types [`Pose`] is made, in the version that it takes.
pub use nalgebra;

pub use bounding_box::bounding_box;
pub use cloud::PointCloud;
pub use covariance::{AxisForm, Covariance, CovarianceError};
pub use drift::{BoxDrift, Drift};
#[cfg(feature = "mesh")]
pub use mesh::{MeshError, TriangleMesh};
pub use motion::Motion;
pub use pose::{Pose, PoseError};
pub use uncertain::UncertainPoint;
pub use unit::{UnitError, unit};
pub use vectors::{Matrix3, Point3, UnitVector3, Vector3};
