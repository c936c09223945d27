//! What a solve returns: multipliers, objective values, and how it ended.

use cloudtouch_geom::Vector3;

/// The outcome of a solve; how it ended is a value in here, never an error.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// Multipliers α in sample order; 0 ≤ α_i ≤ C_i and Σ c_i α_i = 0.
    pub alpha: Vec<f64>,
    /// Cone variables v in sample order and in the paper's convention (eq. 13): |v_i| ≤ r_i α_i, in
    /// the axes of the samples, to be multiplied by the symmetric root of the covariance.
    pub v: Vec<Vector3>,
    /// The bias b, for positions relative to the centre the problem subtracts.
    pub bias: f64,
    /// Value of eq. 10 at this classifier: an upper bound on the optimum.
    pub primal: f64,
    /// Value of eq. 13 at these multipliers: a lower bound on the optimum.
    pub dual: f64,
    /// |w|², the squared norm of the classifier.
    pub squared_norm: f64,
    /// (primal − dual) / primal, recomputed from the multipliers alone.
    pub relative_gap: f64,
    /// How far the probability of a sample may be off by what the gap leaves open: an estimate, from
    /// the share of its bound on f that errors were seen to take. Only where f hardly reaches its
    /// margins, as at tiny penalties or kernel widths; 0 elsewhere, where [`Self::relative_gap`] tells.
    pub probability_error: f64,
    /// How the solve ended.
    pub status: Status,
    /// Which solver gave the answer.
    pub rung: Rung,
    /// What it cost.
    pub effort: Effort,
}

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Status {
    /// The recomputed relative gap is within the tolerance.
    Converged,
    /// Within the tolerance, but w = 0 cannot be excluded (|w|² ≤ 2·gap): the ellipsoids leave no
    /// surface between the clouds, and probabilities read off f would be noise.
    Collapsed,
    /// The step budget ran out (and the fallback, where allowed, did not reach the tolerance).
    StepLimit,
    /// Numbers left the range of `f64`; nothing in the solution can be used.
    NotFinite,
    /// The fallback was asked for on a problem too large for its dense matrix.
    TooLarge,
}

/// The rungs of the ladder of solvers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Rung {
    /// Sequential minimal optimisation with ball steps.
    Smo,
    /// The dense interior point method of this crate.
    InteriorPoint,
    /// Clarabel's interior point method on the same dual.
    Clarabel,
}

/// Counters of a solve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Effort {
    /// SMO steps of either kind.
    pub smo_steps: usize,
    /// Those of them that only turned one point's cone vector.
    pub ball_steps: usize,
    /// Kernel rows computed.
    pub kernel_rows: usize,
    /// Iterations of the dense interior point method.
    pub interior_iterations: usize,
    /// Iterations of Clarabel.
    pub clarabel_iterations: usize,
}

/// Beyond this gap errors of 0.6 in a probability have been seen.
const LARGEST_GAP: f64 = 3e-2;
/// With a larger estimate of the error a probability is not read.
pub(crate) const LARGEST_ERROR: f64 = 0.1;

impl Solution {
    /// Whether probabilities may be read: the gap is at most 3e-2, w is known not to vanish, and no
    /// sample's probability may be off by more than 0.1 ([`Self::probability_error`]).
    pub fn determines_probabilities(&self) -> bool {
        matches!(self.status, Status::Converged | Status::StepLimit)
            && self.relative_gap <= LARGEST_GAP
            && self.squared_norm > 2.0 * self.relative_gap * self.primal
            && self.probability_error <= LARGEST_ERROR
    }
}
