//! Positions as a k-d tree takes them.

use cloudtouch_geom::Point3;
use kiddo::ImmutableKdTree;

use crate::error::NoiseError;

/// An index, and a position.
pub(crate) type Entry = (u32, [f64; 3]);

/// Adding zero turns -0 into 0, which is the same place.
pub(crate) fn entry(index: u32, point: &Point3) -> Entry {
    (index, point.coords.map(|v| v + 0.0).into())
}

pub(crate) fn tree_of(entries: &[Entry]) -> Result<ImmutableKdTree<f64, 3>, NoiseError> {
    ImmutableKdTree::new_from_entries(entries)
        .map_err(|error| NoiseError::Index { points: entries.len(), reason: error.to_string() })
}
