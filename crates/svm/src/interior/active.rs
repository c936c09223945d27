//! The interior point method on the points that matter: those with a multiplier, and those near the
//! margin. Its iterations are cubic in the points, and of two surfaces that face one another most are
//! far behind others.

use crate::interior;
use crate::smo::Tools;
use crate::smo::state::{Dual, Numbers, State};
use crate::status::Status;

/// How far outside of the margin, in margins, a point without a multiplier is left out.
const CLEAR: f64 = 0.1;
/// Where more of the points than this share matter, all are taken.
const MOST: f64 = 0.9;
/// How often what was left out wrongly is taken in, before all are taken.
const ROUNDS: usize = 4;

/// Solves the dual from where SMO left it to `relative_gap`, or as far as rounding and `allowed`
/// iterations let it; says how that ended.
///
/// A point that is left out keeps its multiplier of 0. The gap is that of all points: where it is within
/// the tolerance, nothing was left out wrongly.
pub(crate) fn interior_point<'a>(
    so_far: &mut State<'a>,
    relative_gap: f64,
    allowed: usize,
    tools: &mut Tools<'_, '_>,
) -> (Option<State<'a>>, Status) {
    let problem = so_far.problem;
    let mut duals: Vec<Dual> = (0..problem.len()).map(|i| so_far.dual(i)).collect();
    let mut matters = vec![false; problem.len()];
    take_in(so_far, &mut matters);
    // Far from the optimum it does not show yet which points matter.
    let rounds = if so_far.certificate().relative_gap() <= interior::FAR { ROUNDS } else { 0 };
    for _ in 0..rounds {
        let some: Vec<usize> = (0..problem.len()).filter(|&i| matters[i]).collect();
        if some.len() as f64 > MOST * problem.len() as f64 {
            break;
        }
        let start: Vec<Dual> = some.iter().map(|&i| duals[i]).collect();
        let part = problem.of_some(&some);
        let found = interior::solve(&part, &start, relative_gap, allowed, &mut tools.watch);
        tools.effort.interior_iterations += found.iterations;
        for (&i, dual) in some.iter().zip(found.duals.into_iter().flatten()) {
            duals[i] = dual;
        }
        let mut state = State::from_duals(problem, Numbers::default(), duals.clone(), tools.rows);
        if state.certificate().relative_gap() <= relative_gap {
            return (Some(state), Status::Converged);
        }
        if found.status == Status::Cancelled {
            return (Some(state), Status::Cancelled);
        }
        if found.status != Status::Converged || !take_in(&mut state, &mut matters) {
            break;
        }
    }
    let found = interior::solve(problem, &duals, relative_gap, allowed, &mut tools.watch);
    tools.effort.interior_iterations += found.iterations;
    let state =
        found.duals.map(|duals| State::from_duals(problem, Numbers::default(), duals, tools.rows));
    (state, found.status)
}

/// Adds the points that matter here to those that did; false where these were all.
fn take_in(state: &mut State<'_>, matters: &mut [bool]) -> bool {
    let bias = state.certificate().bias;
    let before = matters.iter().filter(|matters| **matters).count();
    for (i, matters) in matters.iter_mut().enumerate() {
        *matters |= state.numbers.alpha.at(i) > 0.0 || state.excess(i, bias) > -CLEAR;
    }
    matters.iter().filter(|matters| **matters).count() > before
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Point3, UncertainPoint};
    use proptest::prelude::*;

    use super::*;
    use crate::problem::Problem;
    use crate::problem::kernel::Kernel;
    use crate::problem::sample::{Class, Sample};
    use crate::smo::rows::KernelRows;
    use crate::smo::{Limits, improve};
    use crate::solution::Effort;
    use crate::watch::Watch;

    /// A bowl over a floor.
    fn problem(places: &[[f64; 3]], gap: f64, std: [f64; 3]) -> Problem {
        let sample = |(k, &[x, y, noise]): (usize, &[f64; 3])| {
            let is_bowl = k % 2 == 0;
            let height = if is_bowl { gap + 0.8 * (x * x + y * y) } else { 0.0 };
            Sample {
                point: UncertainPoint {
                    mean: Point3::new(x, y, height + 0.02 * noise),
                    covariance: Covariance::diagonal(std.map(|std| std * std)),
                },
                class: if is_bowl { Class::A } else { Class::B },
                radius: 1.0,
                penalty: 100.0,
            }
        };
        let samples: Vec<Sample> = places.iter().enumerate().map(sample).collect();
        Problem::new(&samples, Kernel::Gaussian { gamma: 10.0 }).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn what_is_left_out_changes_nothing_beyond_the_gap(
            places in prop::collection::vec(prop::array::uniform3(-0.5..0.5_f64), 16..40),
            (gap, wide, flat) in (-0.05..0.3_f64, 0.01..0.1_f64, 0.001..0.02_f64),
            (steps, tolerance) in (0..200_usize, -6.0..-2.0_f64),
        ) {
            let problem = problem(&places, gap, [wide, wide, flat]);
            let tolerance = 10_f64.powf(tolerance);
            let mut rows = KernelRows::default();
            rows.reset(&problem);
            let mut tools =
                Tools { rows: &mut rows, watch: Watch::nobody(), effort: Effort::default() };
            let mut state = State::cold(&problem, Numbers::default());
            let (predict, gives_way) = (false, false);
            let limits = Limits { relative_gap: tolerance, max_steps: steps, predict, gives_way };
            improve(&mut state, &limits, &mut tools);
            let duals: Vec<Dual> = (0..problem.len()).map(|i| state.dual(i)).collect();

            let (found, end) = interior_point(&mut state, tolerance, 1000, &mut tools);
            let found = found.unwrap().certificate();
            let all = interior::solve(&problem, &duals, tolerance, 1000, &mut tools.watch);
            let mut all =
                State::from_duals(&problem, Numbers::default(), all.duals.unwrap(), tools.rows);
            let all = all.certificate();
            prop_assert_eq!(end, Status::Converged);
            prop_assert!(found.relative_gap() <= tolerance);
            // Each optimum is between its own bounds, and they are of one problem.
            let rounding = 1e-12 * all.primal;
            prop_assert!(found.dual <= all.primal + rounding && all.dual <= found.primal + rounding);
        }
    }
}
