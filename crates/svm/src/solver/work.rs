//! What each rung of the ladder may do at most. The bounds count operations and not time, so that
//! an answer never depends on the machine; together they let a solve take some seconds at worst.

use cloudtouch_geom::Vector3;

use crate::problem::Problem;

/// Steps of SMO that serve even the smallest problem.
const BASE_STEPS: usize = 50;
/// No automatic budget of steps is larger.
const MOST_STEPS: usize = 200_000;
/// Steps times points, as a step visits all of them: about three seconds.
const MOST_VISITS: usize = 300_000_000;
/// Iterations of the interior point method times variables³: about three seconds.
const MOST_ENTRIES: usize = 80_000_000_000;
/// An iteration of Clarabel, whose matrix is sparse and larger, takes this many of ours.
const CLARABEL_COST: usize = 8;
/// A second-order method that cannot take as many iterations is not begun.
const LEAST_ITERATIONS: usize = 15;

/// The automatic budget of SMO steps for a problem of `points` points.
pub(crate) fn step_budget(points: usize) -> usize {
    let usual = (points.saturating_mul(points) / 2 + BASE_STEPS).min(MOST_STEPS);
    usual.min(MOST_VISITS / points.max(1)).max(BASE_STEPS)
}

/// Iterations the dense interior point method may take; `None` when too few to be of use.
pub(crate) fn interior_iterations(problem: &Problem) -> Option<usize> {
    iterations(MOST_ENTRIES, variables(problem))
}

/// Iterations Clarabel may take as a fallback; `None` when too few to be of use.
pub(crate) fn clarabel_iterations(problem: &Problem) -> Option<usize> {
    iterations(MOST_ENTRIES / CLARABEL_COST, variables(problem))
}

fn iterations(entries: usize, variables: usize) -> Option<usize> {
    let cube = variables.saturating_mul(variables).saturating_mul(variables).max(1);
    Some(entries / cube).filter(|&allowed| allowed >= LEAST_ITERATIONS)
}

/// Scalar variables of the dual: a multiplier a point, and an axis for each variance it has.
fn variables(problem: &Problem) -> usize {
    let axes = |t: &Vector3| t.iter().filter(|t| **t > 0.0).count();
    problem.points.iter().map(|point| 1 + axes(&point.t)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn budgets_shrink_where_steps_are_dear_and_never_to_nothing() {
        assert_eq!(step_budget(2), 52);
        assert_eq!(step_budget(40), 850);
        assert_eq!(step_budget(500), 125_050);
        assert_eq!(step_budget(100_000), 3000);
        assert_eq!(step_budget(usize::MAX), BASE_STEPS);
    }

    #[test]
    fn large_matrices_are_not_begun() {
        // 2×20 uncertain points, 2×100, and the largest matrix there is memory for.
        assert_eq!(iterations(MOST_ENTRIES, 160), Some(19_531));
        assert_eq!(iterations(MOST_ENTRIES, 800), Some(156));
        assert_eq!(iterations(MOST_ENTRIES, 2400), None);
        assert_eq!(iterations(MOST_ENTRIES, usize::MAX), None);
    }
}
