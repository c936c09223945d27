//! Plain data that every cloudtouch crate shares: points with covariances, poses, clouds and
//! triangle meshes as read from files, the normal distribution, and seeds.
//!
//! Nothing here knows what a sensor, a classifier or a tree is. Units are metres and radians.
//!
//! ```
//! use cloudtouch_geom::{Covariance, normal};
//! use nalgebra::Vector3;
//!
//! let covariance = Covariance::diagonal([0.01_f64.powi(2), 0.01_f64.powi(2), 0.0]);
//! assert!((covariance.std_along(&Vector3::x()) - 0.01).abs() < 1e-12);
//! // The chance that a standard normal variable exceeds 12 is small, not zero.
//! assert!(normal::upper_tail(12.0) > 1e-33);
//! ```

mod cloud;
mod covariance;
mod mesh;
pub mod normal;
mod pose;
pub mod seed;
mod uncertain;

pub use cloud::PointCloud;
pub use covariance::{Covariance, CovarianceError};
pub use mesh::{MeshError, TriangleMesh};
pub use pose::{Pose, PoseError};
pub use uncertain::UncertainPoint;

/// A point in metres; which frame it is in is said where it is used.
pub type Point3 = nalgebra::Point3<f64>;
/// A direction or displacement in metres.
pub type Vector3 = nalgebra::Vector3<f64>;
/// A 3×3 matrix.
pub type Matrix3 = nalgebra::Matrix3<f64>;
