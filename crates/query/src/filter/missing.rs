//! Missing returns: rows where the sensor saw nothing.

use cloudtouch_geom::Point3;

/// What some sensors write for "no return" is the largest float, 3.4e38; no scene is so large, m.
const PLACEHOLDER: f64 = 1e30;

/// Whether a row stands for no return: a coordinate is NaN, infinite or a placeholder.
pub(super) fn is_missing(point: &Point3) -> bool {
    !point.iter().all(|v| v.abs() < PLACEHOLDER)
}
