//! The axis-aligned box around points.

use crate::vectors::Point3;

/// Lowest and highest corner of some points with finite coordinates, m, in their frame; `None` when there is
/// none.
pub fn bounding_box<'a>(points: impl IntoIterator<Item = &'a Point3>) -> Option<(Point3, Point3)> {
    let mut points = points.into_iter();
    let first = *points.next()?;
    Some(points.fold((first, first), |(low, high), p| (low.inf(p), high.sup(p))))
}
