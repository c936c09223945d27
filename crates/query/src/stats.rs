//! What a query cost.

use serde::Serialize;

/// What a query did: the cost that follows from how hard the pair was.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Stats {
    /// Pairs of tree nodes tested, and nodes tested against a mesh.
    pub nodes_visited: usize,
    /// Pairs of leaves whose points were looked at.
    pub leaf_pairs: usize,
    /// Leaf pairs that a plane separates so well that no kernel problem was solved.
    pub linear_certificates: usize,
    /// Kernel problems solved.
    pub kernel_solves: usize,
    /// Kernel problems handed to the fallback solver.
    pub fallbacks: usize,
    /// Leaf pairs without an answer.
    pub undecided: usize,
    /// Largest relative gap between primal and dual value of any kernel problem.
    pub max_relative_gap: f64,
    /// Time to prepare the two bodies, once for all queries, µs.
    pub prepare_us: u64,
    /// Time of this query, µs.
    pub query_us: u64,
    /// Leaves whose noise model was computed for the first time by this query.
    #[serde(skip)]
    pub leaves_prepared: usize,
}
