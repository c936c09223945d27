//! Coordinates that can be reckoned with: beyond, squares and volumes leave the range of `f64`.

use cloudtouch_geom::{Point3, Pose};

use crate::error::PrepareError;

/// Sixth powers of such coordinates, as squared volumes have, are still finite, m.
pub(crate) const LARGEST_COORDINATE: f64 = 1e50;

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
