//! How far the optimum can be from a dual point: bounds from its duality gap.
//!
//! With gap = (P − P*) + (D* − D), and both objectives strongly convex in w, |w − w*|² ≤ gap; and at
//! the optimum gap ≥ Σ (C−α)(y*−cb*)₊ + α(y*−cb*)₋, so that every single term bounds b*.

use cloudtouch_geom::{Vector3, normal};

use crate::certificate::Certificate;
use crate::problem::kernel::Kernel;
use crate::problem::{PreparedPoint, Problem};
use crate::smo::state::State;
use crate::solution::ErrorBounds;

/// The feature vector ρφ(centre) that others are measured from.
///
/// With Σcα = 0 a function f₀ may be measured from any; φ(centre) makes |φ(x) − ρφ(centre)| small for
/// a wide Gaussian, a small ρ keeps it from exceeding 1 for a narrow one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Reference {
    kernel: Kernel,
    /// 1 − ρ, where ρ is the least k(x, centre) of a sample.
    less: f64,
}

impl Reference {
    pub(crate) fn of(problem: &Problem) -> Self {
        let kernel = problem.kernel;
        let halves = problem.points.iter().map(|p| 0.5 * kernel.squared_reach(&p.x));
        let less = match kernel {
            Kernel::Linear => 0.0,
            Kernel::Gaussian { .. } => halves.fold(0.0, f64::max),
        };
        Self { kernel, less }
    }

    /// |φ(x) − ρφ(centre)|, for `x` relative to the centre.
    pub(crate) fn distance(&self, x: &Vector3) -> f64 {
        (self.less * self.less + (1.0 - self.less) * self.kernel.squared_reach(x)).sqrt()
    }

    /// By how much ∇f is off at most, for each unit that w is.
    pub(crate) fn slope(&self) -> f64 {
        self.kernel.self_curvature().sqrt()
    }
}

/// A value and a standard deviation with their errors, and the range of probabilities they allow.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Range {
    /// Signed value of f, from and to: positive on the own side.
    pub(crate) value: [f64; 2],
    /// |S∇f|, from and to.
    pub(crate) deviation: [f64; 2],
}

impl Range {
    /// The least and the largest probability of being on the wrong side (eq. 16).
    pub(crate) fn probabilities(&self) -> [f64; 2] {
        let [near, far] = self.deviation;
        let [low, high] = self.value;
        let least = normal::below_zero(high, if high > 0.0 { near } else { far });
        let most = normal::below_zero(low, if low < 0.0 { near } else { far });
        [least, most]
    }
}

/// The bounds for the state of this certificate.
pub(crate) fn error_bounds(state: &State<'_>, certificate: &Certificate) -> ErrorBounds {
    let problem = state.problem;
    let reference = Reference::of(problem);
    let (points, numbers) = (&problem.points, &state.numbers);
    let rounding = f64::EPSILON * (1.0 + certificate.bias.abs() + feature_lengths(state));
    let penalties: f64 = points.iter().map(|p| p.penalty).sum();
    let gap = certificate.gap + rounding * penalties;
    let weight = gap.sqrt();
    let slope = reference.slope();
    let mut bias = [f64::NEG_INFINITY, f64::INFINITY];
    for (i, point) in points.iter().enumerate() {
        let alpha = numbers.alpha.at(i);
        let off = weight * (reference.distance(&point.x) + slope * point.t[0]) + rounding;
        let y = state.violation(i);
        // What cb* may be: (C−α)(y*−cb*)₊ and α(y*−cb*)₋ are each at most the gap.
        let [low, high] = [y - off - gap / (point.penalty - alpha), y + off + gap / alpha];
        let [low, high] = if point.sign > 0.0 { [low, high] } else { [-high, -low] };
        bias = [bias[0].max(low), bias[1].min(high)];
    }
    let mut bounds = ErrorBounds { weight, bias, probability: 0.0 };
    for (i, point) in points.iter().enumerate().filter(|(_, p)| p.std[0] > 0.0) {
        let deviation = point.deviation(&numbers.field.gradient_at(i));
        let value = point.sign * (numbers.field.f.at(i) + certificate.bias);
        let off = weight * reference.distance(&point.x);
        let values = bias.map(|bias| point.sign * (numbers.field.f.at(i) + bias));
        let value_range = [values[0].min(values[1]) - off, values[0].max(values[1]) + off];
        let deviation_off = weight * slope * point.std[0];
        let range = Range {
            value: value_range,
            deviation: [(deviation - deviation_off).max(0.0), deviation + deviation_off],
        };
        let [least, most] = range.probabilities();
        let probability = normal::below_zero(value, deviation);
        let worst = (most - probability).max(probability - least);
        // Not a number counts as not known at all.
        bounds.probability =
            if worst.is_nan() { 1.0 } else { bounds.probability.max(worst.min(1.0)) };
    }
    bounds
}

/// How far the probability of a sample moves, at most, while the bias takes the values of `interval`;
/// of a sample without covariance, the width of the interval where its side changes.
pub(crate) fn bias_spread(state: &State<'_>, interval: [f64; 2]) -> f64 {
    let numbers = &state.numbers;
    let spread = |i: usize| {
        let point = &state.problem.points[i];
        let deviation = point.deviation(&numbers.field.gradient_at(i));
        let [low, high] = interval.map(|bias| point.sign * (numbers.field.f.at(i) + bias));
        if deviation > 0.0 {
            let [p, q] = [low, high].map(|value| normal::below_zero(value, deviation));
            (p - q).abs()
        } else if low * high < 0.0 {
            (high - low).abs().min(1.0)
        } else {
            0.0
        }
    };
    (0..state.problem.len()).map(spread).fold(0.0, f64::max)
}

/// Whether w = 0 cannot be excluded.
pub(crate) fn is_collapsed(state: &State<'_>, certificate: &Certificate) -> bool {
    // What rounding alone can leave of |w|² when w = 0: the terms of βᵀBβ cancel.
    let rounding = f64::EPSILON * feature_lengths(state).powi(2);
    certificate.squared_norm <= certificate.gap + rounding
}

/// Σ α|φ(x) − ρφ(centre)| + |D p|: the length of w if all of its terms pointed one way.
fn feature_lengths(state: &State<'_>) -> f64 {
    let problem = state.problem;
    let reference = Reference::of(problem);
    let slope = reference.slope();
    let length = |(i, point): (usize, &PreparedPoint)| {
        let displacement = point.displacement(&state.numbers.p(i));
        state.numbers.alpha.at(i) * reference.distance(&point.x) + displacement.norm() * slope
    };
    problem.points.iter().enumerate().map(length).sum()
}
