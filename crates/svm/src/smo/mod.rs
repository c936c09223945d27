//! Rung 1: sequential minimal optimisation with ball steps.
//!
//! Writing v = α u with |u| ≤ r, two kinds of step alternate: a pair step moves (α_i, α_j) with u
//! fixed, a ball step turns one u with α fixed. A point where neither can gain satisfies the
//! optimality conditions of the convex dual (eq. 13).

pub(crate) mod ball;
mod choose;
mod local;
pub(crate) mod rows;
mod spread;
pub(crate) mod state;

use cloudtouch_geom::Vector3;

use crate::certificate::Certificate;
use crate::smo::choose::{choose_pair, most_misaligned};
use crate::smo::local::{Local, pair_step};
use crate::smo::rows::KernelRows;
use crate::smo::spread::Source;
use crate::smo::state::State;
use crate::solution::Effort;
use crate::status::{Rung, Status};
use crate::watch::Watch;

/// How far to go.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    pub(crate) relative_gap: f64,
    pub(crate) max_steps: usize,
    /// Whether to leave as soon as the gap's decay says that `max_steps` will not do.
    pub(crate) predict: bool,
    /// With that, whether to leave sooner where the gap is [`FAR`].
    pub(crate) gives_way: bool,
}

/// How often the largest misalignment competes with the best pair: more often than every third
/// step costs more in scans than it saves in steps, less often takes up to five times the steps.
const BALL_STEP_EVERY: usize = 3;

/// A point of a pair is turned before the two are moved where that gains this share of what moving them
/// does: less costs more than it saves in steps.
const WORTH_TURNING: f64 = 0.05;

/// Steps a sample after which the decay of the gap tells where it leads; fewer give up on problems
/// that SMO would soon have done.
const TOLD_AFTER: usize = 4;

/// A relative gap beyond which, three steps for two samples after the start, a small problem is for the
/// interior point method: of some hundred problems that SMO solved none was beyond 0.89 even before.
const FAR: f64 = 0.98;

/// What a solve is done with.
pub(crate) struct Tools<'r, 'w> {
    /// The kernel rows of the problem.
    pub(crate) rows: &'r mut KernelRows,
    pub(crate) watch: Watch<'w>,
    pub(crate) effort: Effort,
}

/// Improves `state` until its gap is within the limit, the steps run out, nothing moves or the watch
/// says to stop.
///
/// The certificate returned is recomputed from the dual variables alone.
pub(crate) fn improve(
    state: &mut State<'_>,
    limits: &Limits,
    tools: &mut Tools<'_, '_>,
) -> (Certificate, Status) {
    let n = state.problem.len();
    let check_every = (n / 2).clamp(8, 256);
    let mut history: Vec<(usize, f64)> = Vec::new();
    let mut steps = 0;
    loop {
        let mut stuck = false;
        for _ in 0..check_every.min(limits.max_steps.saturating_sub(steps)) {
            if !step(state, tools, steps % BALL_STEP_EVERY == 0) {
                stuck = true;
                break;
            }
            steps += 1;
        }
        let running = state.certificate();
        let gap = running.relative_gap();
        history.push((steps, gap));
        let end =
            if tools.watch.shows_stop(Rung::Smo, steps, &running, || state.largest_violation()) {
                Status::Cancelled
            } else if !running.is_finite() {
                Status::NotFinite
            } else if stuck {
                Status::Stalled
            } else if steps >= limits.max_steps {
                Status::StepLimit
            } else if gap <= limits.relative_gap {
                Status::Converged
            } else if limits.predict && hopeless(&history, limits, n) {
                Status::SlowProgress
            } else {
                continue;
            };
        state.recompute(tools.rows);
        let fresh = state.certificate();
        let reached = fresh.relative_gap() <= limits.relative_gap;
        // Rounding in the running sums can hide a gap: then the fresh ones go on.
        if end == Status::Converged && !reached && fresh.is_finite() {
            continue;
        }
        tools.effort.smo_steps += steps;
        return (fresh, if reached { Status::Converged } else { end });
    }
}

/// Whether SMO gives way to the interior point method or, after a quarter of the budget or [`TOLD_AFTER`]
/// steps a sample, the log-linear decay of the gap over the second half of the run misses the tolerance at
/// the end of the budget.
fn hopeless(history: &[(usize, f64)], limits: &Limits, samples: usize) -> bool {
    let Some(&(steps, gap)) = history.last() else { return false };
    if limits.gives_way && 2 * steps >= 3 * samples && gap > FAR {
        return true;
    }
    if steps < (limits.max_steps / 4).min(TOLD_AFTER * samples) {
        return false;
    }
    let Some(&(from, before)) = history.iter().rev().find(|entry| entry.0 <= steps / 2) else {
        return false;
    };
    let rate = (before / gap).ln() / (steps - from) as f64;
    let missing = (gap / limits.relative_gap).ln();
    rate.is_nan() || rate <= 0.0 || steps as f64 + missing / rate > limits.max_steps as f64
}

/// Takes one step; false when no step gains anything.
fn step(state: &mut State<'_>, tools: &mut Tools<'_, '_>, consider_ball: bool) -> bool {
    let rows = &mut *tools.rows;
    let pair = choose_pair(state, rows);
    let pair_gain = pair.as_ref().map_or(0.0, |pair| pair.gain);
    if consider_ball || pair.is_none() {
        let (turning, gain) = most_misaligned(state);
        // α is what |g| is multiplied by, and |g| is in margins: less is rounding.
        if gain > pair_gain && gain > 1e-16 * state.numbers.alpha.at(turning) {
            tools.effort.ball_steps += 1;
            let mut local = Local::new(state, turning);
            local.ball_step();
            let moved = local.change.s != Vector3::zeros();
            rows.ensure(state.problem, turning);
            commit(state, rows, &local, None);
            return moved;
        }
    }
    let Some(pair) = pair else { return false };
    rows.ensure(state.problem, pair.i);
    rows.ensure_beside(state.problem, pair.j, pair.i);
    let k = rows.at(pair.i, pair.j);
    let (mut first, mut second) = (Local::new(state, pair.i), Local::new(state, pair.j));
    let turn = |of: &mut Local<'_>, other: &mut Local<'_>| {
        let is_worth = state.misalignment(of.index) > WORTH_TURNING * pair.gain;
        let s = if is_worth { of.ball_step() } else { Vector3::zeros() };
        let has_turned = s != Vector3::zeros();
        if has_turned {
            other.feel(of, k, &s);
        }
        has_turned
    };
    let turned = turn(&mut first, &mut second) | turn(&mut second, &mut first);
    let moved = pair_step(&mut first, &mut second, k) || turned;
    if moved {
        commit(state, rows, &first, Some(&second));
    }
    moved
}

/// Writes one or two moved points back and carries their changes to all points.
fn commit(state: &mut State<'_>, rows: &KernelRows, first: &Local<'_>, second: Option<&Local<'_>>) {
    let problem = state.problem;
    for local in [Some(first), second].into_iter().flatten() {
        state.numbers.put(local.index, local.alpha, &local.p);
    }
    let source = |local: &Local<'_>| {
        let x = problem.points[local.index].x;
        Source { x, row: rows.row(local.index), a: local.change.a, s: local.change.s }
    };
    let field = &mut state.numbers.field;
    match second {
        None => field.add(problem, &[source(first)], problem.has_uncertain),
        Some(second) => {
            field.add(problem, &[source(first), source(second)], problem.has_uncertain);
        }
    }
}
