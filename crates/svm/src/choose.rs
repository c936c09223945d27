//! Which points an SMO step moves.

use crate::rows::KernelRows;
use crate::state::State;

/// Two points to move against one another, and what that gains about.
pub(crate) struct Pair {
    pub(crate) i: usize,
    pub(crate) j: usize,
    pub(crate) gain: f64,
}

/// The maximal violator among the points that may go up, and the partner of the largest
/// second-order gain; `None` when no pair violates the optimality conditions beyond rounding.
pub(crate) fn choose_pair(state: &State<'_>, rows: &mut KernelRows) -> Option<Pair> {
    let points = &state.problem.points;
    let mut best: Option<(usize, f64)> = None;
    for (k, point) in points.iter().enumerate() {
        let [may_rise, _] = point.may_move(state.numbers.alpha[k]);
        let value = point.sign * state.violation(k);
        if may_rise && best.is_none_or(|(_, highest)| value > highest) {
            best = Some((k, value));
        }
    }
    let (i, highest) = best?;
    rows.ensure(state.problem, i);
    let row = rows.row(i);
    let kernel = state.problem.kernel;
    // In margins, as y is: what is left below this is rounding.
    let threshold = highest - 1e-14 * highest.abs().max(1.0);
    let mut chosen: Option<Pair> = None;
    for (k, point) in points.iter().enumerate() {
        let [_, may_fall] = point.may_move(state.numbers.alpha[k]);
        let value = point.sign * state.violation(k);
        if !may_fall || value >= threshold {
            continue;
        }
        let curvature = kernel.squared_distance(&points[i].x, &point.x, row[k]);
        // Duplicates have none: the step between them runs to a bound.
        let gain = (highest - value).powi(2) / curvature.max(f64::MIN_POSITIVE);
        if chosen.as_ref().is_none_or(|best| gain > best.gain) {
            chosen = Some(Pair { i, j: k, gain });
        }
    }
    chosen
}

/// The point whose cone vector, turned against the gradient, gains most, and how much.
pub(crate) fn most_misaligned(state: &State<'_>) -> (usize, f64) {
    let mut best = (0, 0.0);
    for (k, point) in state.problem.points.iter().enumerate() {
        if state.numbers.alpha[k] > 0.0 && point.is_uncertain() {
            let gain = state.misalignment(k);
            if gain > best.1 {
                best = (k, gain);
            }
        }
    }
    best
}
