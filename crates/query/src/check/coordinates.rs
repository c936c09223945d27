//! Coordinates that can be reckoned with: beyond, doubles do not tell micrometres apart.

use cloudtouch_geom::{Point3, Pose};

use crate::error::PrepareError;

/// No coordinate of a body or of a pose may be larger, m: its last place is 2 micrometres.
pub const LARGEST_COORDINATE: f64 = 1e10;

/// An entry of a pose that cannot be reckoned with.
pub(crate) fn bad_entry(pose: &Pose) -> Option<f64> {
    let beyond = |v: &f64| v.abs() > LARGEST_COORDINATE;
    pose.non_finite_entry().or_else(|| pose.translation().iter().copied().find(beyond))
}

/// Whether all points, given with their indices, can be reckoned with.
pub(crate) fn check_points<'a>(
    points: impl IntoIterator<Item = (usize, &'a Point3)>,
) -> Result<(), PrepareError> {
    let beyond = |v: &f64| v.is_nan() || v.abs() > LARGEST_COORDINATE;
    for (index, point) in points {
        if let Some(&value) = point.iter().find(|v| beyond(v)) {
            return Err(PrepareError::CoordinateRange { index, value });
        }
    }
    Ok(())
}
