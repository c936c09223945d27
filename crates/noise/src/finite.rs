//! Missing returns.

use cloudtouch_geom::Point3;

/// Whether a point is one: a missing return is NaN.
pub(crate) fn is_finite(point: &Point3) -> bool {
    point.coords.iter().all(|v| v.is_finite())
}
