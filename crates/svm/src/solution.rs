//! What a solve returns: multipliers, objective values, error bounds, and how it ended.

use cloudtouch_geom::Vector3;

use crate::status::{Ends, Rung, Status};

/// The outcome of a solve; how it ended is a value in here, never an error.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Solution {
    /// Multipliers α in sample order; 0 ≤ α_i ≤ C_i and Σ c_i α_i = 0.
    pub alpha: Vec<f64>,
    /// Cone variables v in sample order and in the paper's convention (eq. 13): |v_i| ≤ r_i α_i, in
    /// the axes of the samples, to be multiplied by the symmetric root of the covariance.
    pub v: Vec<Vector3>,
    /// The displacements S v (eq. 14) in sample order. Where an ellipsoid is much thinner than wide
    /// these keep digits that v, in the axes of the samples, has not.
    pub displacement: Vec<Vector3>,
    /// The bias b, for positions relative to [the problem's centre](crate::Problem::centre): one
    /// that minimises the primal value for this w, the middle of them where there are many.
    pub bias: f64,
    /// The biases, lowest and highest, that the gap cannot tell apart from [`Self::bias`]: within
    /// them the primal value rises by no more than the gap. Where no multiplier is free this stays
    /// an interval however small the gap is: then b is not determined by the problem.
    pub bias_interval: [f64; 2],
    /// How far the probability of a sample moves, at most over all of them, while b takes the values
    /// of [`Self::bias_interval`]. A sample without covariance, which has no probability but a side,
    /// counts with the width of the interval in margins where its side changes.
    pub bias_spread: f64,
    /// Value of eq. 10 at this classifier: an upper bound on the optimum.
    pub primal: f64,
    /// Value of eq. 13 at these multipliers: a lower bound on the optimum.
    pub dual: f64,
    /// |w|², the squared norm of the classifier.
    pub squared_norm: f64,
    /// (primal − dual) / primal, recomputed from the multipliers alone.
    pub relative_gap: f64,
    /// How far the optimum can be from here.
    pub error: ErrorBounds,
    /// How the solve ended; short of the tolerance, what kept it from there.
    pub status: Status,
    /// How each rung ended.
    pub ends: Ends,
    /// Which solver gave the answer.
    pub rung: Rung,
    /// What it cost.
    pub effort: Effort,
}

/// Bounds on what separates a solution from the optimum, from its duality gap alone.
///
/// The primal is strongly convex in w and so is the dual: |w − w*|² ≤ gap, and f − b is off by at
/// most |w − w*| times the length of a feature vector. These are guarantees, up to the rounding
/// counted in, and far from tight where slack makes up the gap: errors seen are tens of times
/// smaller at a relative gap of 1e-3. The bounds go down with the root of the gap.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ErrorBounds {
    /// |w − w*| is at most this.
    pub weight: f64,
    /// Every optimal b lies within these, once w* is in place of w and measured, as
    /// [`Classifier::value_bounds`](crate::Classifier::value_bounds) does, from a feature vector in
    /// the middle of the samples.
    pub bias: [f64; 2],
    /// The probability of a sample (eq. 16) is off by at most this; samples without covariance,
    /// which have a side and no probability, are not counted.
    pub probability: f64,
}

/// Counters of a solve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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

/// Why no probability may be read off a solution.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Undetermined {
    /// Numbers left the range of `f64`.
    #[error("the solve left the range of f64: scale the samples to about unit size")]
    NotFinite,
    /// The gap is above 3e-2.
    #[error("the solve ended with a relative gap of {relative_gap:.1e} ({status}): solve further")]
    Gap {
        /// How the solve ended.
        status: Status,
        /// How far it got.
        relative_gap: f64,
    },
    /// w = 0 cannot be excluded.
    #[error("nothing separates the classes: w = 0 cannot be excluded")]
    Collapsed,
    /// w is known too loosely.
    #[error("the gap leaves w open by {relative_error:.2} of its length: solve further")]
    Weight {
        /// √gap/|w|.
        relative_error: f64,
    },
    /// b is known too loosely, or left open by the problem itself.
    #[error(
        "the bias may lie anywhere from {lowest} to {highest}: where solving further does not \
         narrow that, no multiplier is free, and penalties have to be larger"
    )]
    Bias {
        /// The lowest bias.
        lowest: f64,
        /// The highest bias.
        highest: f64,
    },
}

/// Beyond this relative gap errors of 0.6 in a probability have been seen.
pub(crate) const LARGEST_GAP: f64 = 3e-2;
/// w has to be known to this share of its length.
const LARGEST_WEIGHT_ERROR: f64 = 0.2;
/// And b so well that no probability moves by more than this.
const LARGEST_SPREAD: f64 = 0.05;

impl Solution {
    /// Whether probabilities may be read.
    ///
    /// This does not ask for [`ErrorBounds::probability`], which is a guarantee and far from tight.
    ///
    /// # Errors
    /// When the relative gap is above 3e-2, when w is not known to a fifth of its length, or when b
    /// is open by so much that the probability of a sample moves by more than 0.05.
    pub fn determined(&self) -> Result<(), Undetermined> {
        let Self { status, relative_gap, bias_interval: [lowest, highest], .. } = *self;
        if status == Status::NotFinite {
            return Err(Undetermined::NotFinite);
        }
        if relative_gap.is_nan() || relative_gap > LARGEST_GAP {
            return Err(Undetermined::Gap { status, relative_gap });
        }
        if status == Status::Collapsed {
            return Err(Undetermined::Collapsed);
        }
        let gap = relative_gap * self.primal;
        if self.squared_norm * LARGEST_WEIGHT_ERROR * LARGEST_WEIGHT_ERROR < gap {
            return Err(Undetermined::Weight { relative_error: (gap / self.squared_norm).sqrt() });
        }
        if self.bias_spread > LARGEST_SPREAD {
            return Err(Undetermined::Bias { lowest, highest });
        }
        Ok(())
    }
}
