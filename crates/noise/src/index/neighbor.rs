//! A point near another.

use std::cmp::Ordering;

/// A nearby point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbor {
    /// Its index in the cloud.
    pub index: usize,
    /// Its squared distance, m².
    pub squared_distance: f64,
}

/// By distance, then index.
pub(crate) fn in_order(a: &Neighbor, b: &Neighbor) -> Ordering {
    a.squared_distance.total_cmp(&b.squared_distance).then(a.index.cmp(&b.index))
}
