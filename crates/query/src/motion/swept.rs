//! What a sweep answers.

use cloudtouch_geom::Pose;
use serde::Serialize;

use crate::doubt::undecided::Undecided;
use crate::doubt::warning::Warning;
use crate::report::{Report, Verdict};

/// How likely two bodies collide along a path.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Swept {
    /// Lower and upper bound on the largest collision probability of any pose of the path, under the
    /// same model: the largest of the poses that were asked about, and what no pose exceeds.
    pub bounds: [f64; 2],
    /// The most probable of the poses that were asked about; [`Self::bounds`] hold its probability.
    pub most_probable: AlongPath,
    /// Where the accept threshold is first exceeded; `None` where no pose that was asked about does. An
    /// upper bound above the threshold then says that one may.
    pub first: Option<Reached>,
    /// Up to this share of the path every pose is free for certain: its upper bound is below the reject
    /// threshold, and nothing speaks against believing it. 1 for a path that is free.
    pub certified_free_until: f64,
    /// The verdict on the whole path: [`Verdict::Free`] where every pose is for certain,
    /// [`Verdict::InCollision`] where some pose is, else as for a pose.
    pub verdict: Verdict,
    /// Why the verdict is undecided: the doubt about the earliest pose that there is one about.
    pub undecided_by: Option<Undecided>,
    /// Signs of a slip at the poses that were looked at: each kind once for each body, as of the
    /// earliest of them.
    pub warnings: Vec<Warning>,
    /// What the answer cost.
    pub stats: SweepStats,
}

/// A pose of a path that was asked about.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AlongPath {
    /// Which segment, from 0, and the time within it, from 0 to 1.
    pub segment: usize,
    /// See [`Self::segment`].
    pub t: f64,
    /// The same as a share of the whole path, each segment having the same part.
    pub share: f64,
    /// From the file frame of B into that of A.
    pub pose: Pose,
    /// The whole answer there, with contacts.
    pub report: Report,
}

/// Where a threshold is first exceeded.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Reached {
    /// The earliest pose that was found to exceed it.
    pub at: AlongPath,
    /// No pose before this share of the path exceeds it. Within the tolerance of [`Self::at`], unless
    /// bounds leave earlier poses open or the deadline was over.
    pub not_before: f64,
}

/// What a sweep did.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SweepStats {
    /// Poses that were asked about.
    pub poses: usize,
    /// Stretches of the path over which the probability was bounded.
    pub stretches: usize,
    /// Pairs of tree nodes tested, by poses and stretches together.
    pub nodes_visited: usize,
    /// Pairs of leaves whose points were looked at.
    pub leaf_pairs: usize,
    /// Kernel problems solved.
    pub kernel_solves: usize,
    /// Time of the sweep, µs.
    pub query_us: u64,
}
