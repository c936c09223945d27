#![doc = include_str!("../README.md")]

mod cloud;
mod covariance;
mod mesh;
pub mod message;
mod motion;
pub mod normal;
mod pose;
pub mod seed;
mod uncertain;

pub use cloud::PointCloud;
pub use covariance::{Covariance, CovarianceError};
pub use mesh::{MeshError, TriangleMesh};
pub use motion::Motion;
pub use pose::{Pose, PoseError};
pub use uncertain::UncertainPoint;

/// A point in metres; which frame it is in is said where it is used.
pub type Point3 = nalgebra::Point3<f64>;
/// A direction or displacement in metres.
pub type Vector3 = nalgebra::Vector3<f64>;
/// A 3×3 matrix.
pub type Matrix3 = nalgebra::Matrix3<f64>;
