//! How far a dual point can be from the optimum.

pub(crate) mod slack;

use crate::certificate::slack::Slack;
use crate::problem::PreparedPoint;

/// A dual point's certificate of how far it can be from the optimum.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Certificate {
    pub(crate) bias: f64,
    pub(crate) primal: f64,
    pub(crate) dual: f64,
    pub(crate) squared_norm: f64,
    /// primal − dual, as a sum of non-negative terms.
    pub(crate) gap: f64,
}

impl Certificate {
    pub(crate) fn is_finite(&self) -> bool {
        [self.bias, self.primal, self.dual, self.squared_norm, self.gap]
            .iter()
            .all(|v| v.is_finite())
    }

    /// gap / primal, infinite when it cannot be told.
    pub(crate) fn relative_gap(&self) -> f64 {
        if self.is_finite() && self.primal > 0.0 { self.gap / self.primal } else { f64::INFINITY }
    }
}

/// What a sample adds to a certificate.
pub(crate) struct Margin {
    pub(crate) alpha: f64,
    /// c f₀.
    pub(crate) value: f64,
    /// |T∇f₀|.
    pub(crate) norm: f64,
    /// p·T∇f₀.
    pub(crate) turned: f64,
}

/// Objective values and gap of a dual point with these margins, and y = 1 − c f₀ + |T∇f₀| alone.
///
/// gap = Σ (C−α)(y−cb)₊ + α(y−cb)₋ + (α|g| + p·g), with b the minimiser of Σ C(y−cb)₊.
pub(crate) fn certify(
    points: &[PreparedPoint],
    slack: &mut Slack,
    violation: impl Fn(usize) -> f64,
    at: impl Fn(usize) -> Margin,
) -> Certificate {
    let terms = points.iter().enumerate();
    slack.set(terms.map(|(i, point)| (point.sign, violation(i), point.penalty)));
    let bias = slack.minimiser();
    let (mut sum, mut squared_norm, mut loss, mut gap) = (0.0, 0.0, 0.0, 0.0);
    for (i, point) in points.iter().enumerate() {
        let margin = at(i);
        let excess = 1.0 - margin.value + margin.norm - point.sign * bias;
        let above = excess.max(0.0);
        sum += margin.alpha;
        squared_norm += margin.alpha * margin.value + margin.turned;
        loss += point.penalty * above;
        gap += (point.penalty - margin.alpha) * above + margin.alpha * (above - excess);
        gap += (margin.alpha * margin.norm + margin.turned).max(0.0);
    }
    let squared_norm = squared_norm.max(0.0);
    Certificate {
        bias,
        primal: 0.5 * squared_norm + loss,
        dual: sum - 0.5 * squared_norm,
        squared_norm,
        gap,
    }
}

/// By how much the optimality conditions are missed, given α and y of each sample: by the values that
/// b must have for the points that may rise and those that may fall.
pub(crate) fn largest_violation(points: &[PreparedPoint], at: impl Fn(usize) -> (f64, f64)) -> f64 {
    let mut highest = f64::NEG_INFINITY;
    let mut lowest = f64::INFINITY;
    for (i, point) in points.iter().enumerate() {
        let (alpha, violation) = at(i);
        let value = point.sign * violation;
        let [may_rise, may_fall] = point.may_move(alpha);
        highest = if may_rise { highest.max(value) } else { highest };
        lowest = if may_fall { lowest.min(value) } else { lowest };
    }
    (highest - lowest).max(0.0)
}
