//! The vectors and matrices everything is written in.

/// A point in metres; which frame it is in is said where it is used.
pub type Point3 = nalgebra::Point3<f64>;
/// A direction or displacement in metres.
pub type Vector3 = nalgebra::Vector3<f64>;
/// A direction of length one, such as a normal; [`unit`](crate::unit()) makes one of any vector.
pub type UnitVector3 = nalgebra::UnitVector3<f64>;
/// A 3×3 matrix.
pub type Matrix3 = nalgebra::Matrix3<f64>;
