//! What a tree holds: uncertain points and exact triangles.

use std::slice;

use cloudtouch_geom::{Covariance, Point3, UncertainPoint, Vector3};

use crate::TreeError;

/// A box over larger coordinates may have sides that single precision does not hold.
const MAX_COORDINATE: f64 = 1e37;
/// The square of [`MAX_COORDINATE`].
const MAX_VARIANCE: f64 = 1e74;

/// One thing a tree holds, in the frame of the tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Primitive {
    /// A point known up to a normal distribution.
    Point {
        /// Where the point is expected and how far it may be from there.
        point: UncertainPoint,
        /// How much of the surface it stands for, by which it counts in the coverage of a node:
        /// in the paper the area of its k-neighbour sphere, m². Only ratios matter; 0 is allowed.
        weight: f64,
    },
    /// An exact triangle; boxes hold all three corners and so all of it. Its weight is its area.
    Triangle([Point3; 3]),
}

impl Primitive {
    /// A point of weight 1, for when areas are unknown.
    pub fn point(point: UncertainPoint) -> Self {
        Self::Point { point, weight: 1.0 }
    }

    /// The points whose convex hull is the primitive: the mean of a point, the corners of a
    /// triangle.
    pub fn corners(&self) -> &[Point3] {
        match self {
            Self::Point { point, .. } => slice::from_ref(&point.mean),
            Self::Triangle(corners) => corners,
        }
    }

    /// The mean of a point, the centroid of a triangle.
    pub fn centroid(&self) -> Point3 {
        centroid(self.corners())
    }

    /// The given weight of a point, the area of a triangle (m²).
    pub fn weight(&self) -> f64 {
        match self {
            Self::Point { weight, .. } => *weight,
            Self::Triangle([p, q, r]) => 0.5 * (q - p).cross(&(r - p)).norm(),
        }
    }

    /// The covariance of a point; `None` for a triangle, which is exact.
    pub fn covariance(&self) -> Option<&Covariance> {
        match self {
            Self::Point { point, .. } => Some(&point.covariance),
            Self::Triangle(_) => None,
        }
    }

    /// Standard deviation (m) along a unit vector; 0 for a triangle.
    pub fn std_along(&self, direction: &Vector3) -> f64 {
        self.covariance().map_or(0.0, |covariance| covariance.std_along(direction))
    }

    /// Refuses values that no box could hold.
    pub(crate) fn check(&self, index: usize) -> Result<(), TreeError> {
        check_coordinates(self.corners(), index)?;
        if let Self::Point { point, weight } = self {
            check_covariance(&point.covariance, index)?;
            if !(weight.is_finite() && *weight >= 0.0) {
                return Err(TreeError::Weight { index, value: *weight });
            }
        }
        Ok(())
    }
}

/// Refuses corners that no box could hold.
pub(crate) fn check_coordinates(corners: &[Point3], index: usize) -> Result<(), TreeError> {
    let coordinates = corners.iter().flat_map(|corner| corner.iter().copied());
    match first_beyond(coordinates, MAX_COORDINATE) {
        Some(value) => Err(TreeError::Coordinate { index, value }),
        None => Ok(()),
    }
}

/// Refuses noise that no box could hold.
pub(crate) fn check_covariance(covariance: &Covariance, index: usize) -> Result<(), TreeError> {
    match first_beyond(covariance.upper_triangle().into_iter(), MAX_VARIANCE) {
        Some(value) => Err(TreeError::Covariance { index, value }),
        None => Ok(()),
    }
}

/// The same of how far the surface of a primitive reaches.
pub(crate) fn check_extent(extent: &Covariance, index: usize) -> Result<(), TreeError> {
    match first_beyond(extent.upper_triangle().into_iter(), MAX_VARIANCE) {
        Some(value) => Err(TreeError::Extent { index, value }),
        None => Ok(()),
    }
}

/// The first of these that is no number or larger, whatever its sign.
fn first_beyond(mut values: impl Iterator<Item = f64> + Clone, most: f64) -> Option<f64> {
    let is_within = |value: f64| value.abs() <= most;
    // PERF: without a branch for each; as a rule all are within.
    let all_are = values.clone().fold(true, |all, value| all & is_within(value));
    if all_are { None } else { values.find(|value| !is_within(*value)) }
}

/// The centroid of a point or of the three corners of a triangle.
pub(crate) fn centroid(corners: &[Point3]) -> Point3 {
    match corners {
        [p, q, r] => p + ((q - p) + (r - p)) / 3.0,
        [point, ..] => *point,
        [] => Point3::origin(),
    }
}
