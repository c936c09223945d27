//! Neighbours that are as near as one another: which of them comes first.
//!
//! On a grid many are, but for rounding, and the first eight of them, say, are whichever these rounded down. By
//! where they lie they are the same wherever the grid is and however its points are numbered. Turned, they are not.

use cloudtouch_geom::Point3;

use crate::index::neighbor::Neighbor;

/// Squared distances that differ by no more than this share of themselves are the same.
const TIED: f64 = 1e-7;
/// Directions are told by so many steps from −1 to 1 of each coordinate.
const STEPS: f64 = 1e4;

/// Whether the next in order is as near as this one.
#[inline]
pub(crate) fn are_tied(near: &Neighbor, next: &Neighbor) -> bool {
    next.squared_distance <= widened(near.squared_distance)
}

/// The squared distance of the farthest that is as near.
#[inline]
pub(crate) fn widened(squared_distance: f64) -> f64 {
    squared_distance * (1.0 + TIED)
}

/// Puts those that are as near as one another in order of x, y and z, those of the first `k` and those tied with
/// the last of them; `found` is in order of distance. Which of the others it has makes no difference.
#[inline]
pub(crate) fn order_ties(points: &[Point3], place: &Point3, k: usize, found: &mut [Neighbor]) {
    // PERF: mostly none are.
    let some = &found[..found.len().min(k + 1)];
    if some.iter().zip(some.iter().skip(1)).any(|(near, next)| are_tied(near, next)) {
        order_tied(points, place, k, found);
    }
}

#[cold]
fn order_tied(points: &[Point3], place: &Point3, k: usize, found: &mut [Neighbor]) {
    let last = k.min(found.len()) - 1;
    let most = widened(found[last].squared_distance);
    let count = found.partition_point(|near| near.squared_distance <= most);
    let found = &mut found[..count];
    let mut from = 0;
    while from < k.min(found.len()) {
        let tied = found[from..].windows(2).take_while(|two| are_tied(&two[0], &two[1])).count();
        if tied > 0 {
            found[from..=from + tied].sort_by_cached_key(|near| direction(points, place, near));
        }
        from += tied + 1;
    }
}

fn direction(points: &[Point3], place: &Point3, near: &Neighbor) -> ([i64; 3], usize) {
    let offset = points[near.index] - place;
    let steps = STEPS / near.squared_distance.sqrt();
    // Of what is at the place itself by its index.
    ([0, 1, 2].map(|k| (offset[k] * steps).round() as i64), near.index)
}
