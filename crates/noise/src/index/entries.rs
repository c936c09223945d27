//! Positions as a k-d tree takes them.

use cloudtouch_geom::Point3;
use kiddo::KdTree;
use kiddo::leaf_strategies::VecOfArenas;
use kiddo::stem_strategies::Eytzinger;

use crate::error::NoiseError;

/// Points of a leaf: with twice as many as by default trees are built sooner, and what is asked for in blocks takes no
/// longer.
const LEAF: usize = 64;

/// A tree over points, by their indices.
pub(crate) type PointTree = KdTree<f64, u32, Eytzinger, VecOfArenas<f64, u32, 3, LEAF>, 3, LEAF>;

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

/// The tree over some of the points of a cloud, by their indices, which are in order and each there once: the
/// same tree, whoever builds it.
pub(crate) fn tree_of(
    points: &[Point3],
    indices: &[u32],
    by: Threads,
) -> Result<PointTree, NoiseError> {
    // Adding zero turns -0 into 0, which is the same place.
    let along = |point: &Point3, axis: usize| point[axis] + 0.0;
    if indices.len() == points.len() {
        // PERF: all of them are read where they are.
        return built(points, along, |index, _| index as u32, by);
    }
    built(indices, |&index, axis| along(&points[index as usize], axis), |_, &index| index, by)
}

fn built<X: Sync>(
    source: &[X],
    along: impl Fn(&X, usize) -> f64 + Sync,
    item: impl Fn(usize, &X) -> u32,
    by: Threads,
) -> Result<PointTree, NoiseError> {
    let builder = PointTree::builder();
    // PERF: alone, what is shared takes longer.
    let built = if by == Threads::This || rayon::current_num_threads() == 1 {
        builder.with_serial_construction().build_from_source(source, along, item)
    } else {
        builder
            .with_parallel_construction_threshold(LEAST_SHARED)
            .build_from_source(source, along, item)
    };
    built.map_err(|error| NoiseError::Index { points: source.len(), reason: error.to_string() })
}
