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

/// Who builds a tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Threads {
    /// The caller alone: whoever waits for others may be given work meanwhile that waits for the caller.
    This,
    /// All of the pool.
    All,
}

/// Trees of fewer are built by who asks for them.
const LEAST_SHARED: usize = 4096;

/// The same tree, whoever builds it.
pub(crate) fn tree_of(
    entries: &[Entry],
    by: Threads,
) -> Result<ImmutableKdTree<f64, 3>, NoiseError> {
    let builder = ImmutableKdTree::builder();
    // PERF: alone, what is shared takes longer.
    let built = if by == Threads::This || rayon::current_num_threads() == 1 {
        builder.with_serial_construction().build_from_entries(entries)
    } else {
        builder.with_parallel_construction_threshold(LEAST_SHARED).build_from_entries(entries)
    };
    built.map_err(|error| NoiseError::Index { points: entries.len(), reason: error.to_string() })
}
