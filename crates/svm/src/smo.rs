//! Rung 1: sequential minimal optimisation with ball steps.
//!
//! Writing v = α u with |u| ≤ r, two kinds of step alternate: a pair step moves (α_i, α_j) with u
//! fixed, a ball step turns one u with α fixed. A point where neither can gain satisfies the
//! optimality conditions of the convex dual (eq. 13).

use cloudtouch_geom::Vector3;

use crate::ball::ball_minimiser;
use crate::problem::Problem;
use crate::rows::KernelRows;
use crate::solution::Effort;
use crate::state::{Certificate, State, scaled_norm};

/// How far to go.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    pub(crate) relative_gap: f64,
    pub(crate) max_steps: usize,
    /// Whether to leave as soon as the gap's decay says that `max_steps` will not do.
    pub(crate) predict: bool,
}

/// How often the largest misalignment competes with the best pair: more often than every third
/// step costs more in scans than it saves in steps, less often takes up to five times the steps.
const BALL_STEP_EVERY: usize = 3;
/// Rounds of (ball i, ball j, pair) on the two chosen points before all others are updated.
const LOCAL_ROUNDS: usize = 2;

/// Improves `state` until its gap is within the limit, the steps run out or nothing moves.
///
/// The certificate returned is recomputed from the dual variables alone.
pub(crate) fn improve(state: &mut State<'_>, limits: &Limits, effort: &mut Effort) -> Certificate {
    let n = state.problem.len();
    let mut rows = KernelRows::new(state.problem);
    let check_every = (n / 2).clamp(8, 256);
    let mut history: Vec<(usize, f64)> = Vec::new();
    let mut steps = 0;
    loop {
        let mut stuck = false;
        for _ in 0..check_every.min(limits.max_steps.saturating_sub(steps)) {
            if !step(state, &mut rows, steps % BALL_STEP_EVERY == 0, effort) {
                stuck = true;
                break;
            }
            steps += 1;
        }
        let running = state.certificate();
        let gap = running.relative_gap();
        let done = gap <= limits.relative_gap || steps >= limits.max_steps || stuck;
        history.push((steps, gap));
        if done || !running.is_finite() || (limits.predict && hopeless(&history, limits)) {
            state.recompute();
            let fresh = state.certificate();
            // Rounding in the running sums can hide a gap: then the fresh ones go on.
            let go_on = fresh.is_finite()
                && gap <= limits.relative_gap
                && fresh.relative_gap() > limits.relative_gap
                && steps < limits.max_steps
                && !stuck;
            if !go_on {
                effort.smo_steps += steps;
                effort.kernel_rows += rows.computed();
                return fresh;
            }
        }
    }
}

/// Whether, after a quarter of the budget, the log-linear decay of the gap over the second half of
/// the run misses the tolerance at the end of the budget.
fn hopeless(history: &[(usize, f64)], limits: &Limits) -> bool {
    let Some(&(steps, gap)) = history.last() else { return false };
    if steps < limits.max_steps / 4 {
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
fn step(
    state: &mut State<'_>,
    rows: &mut KernelRows,
    consider_ball: bool,
    effort: &mut Effort,
) -> bool {
    let pair = choose_pair(state, rows);
    let pair_gain = pair.as_ref().map_or(0.0, |pair| pair.gain);
    if consider_ball || pair.is_none() {
        let (turning, gain) = most_misaligned(state);
        if gain > pair_gain && gain > 1e-16 * state.alpha[turning] {
            effort.ball_steps += 1;
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
    let k = rows.row(pair.i)[pair.j];
    let (mut first, mut second) = (Local::new(state, pair.i), Local::new(state, pair.j));
    let mut moved = false;
    for _ in 0..LOCAL_ROUNDS {
        for turn_first in [true, false] {
            let (turning, other) =
                if turn_first { (&mut first, &mut second) } else { (&mut second, &mut first) };
            let s = turning.ball_step();
            other.feel(turning, k, 0.0, &s);
            moved |= s != Vector3::zeros();
        }
        moved |= pair_step(&mut first, &mut second, k);
    }
    if moved {
        commit(state, rows, &first, Some(&second));
    }
    moved
}

struct Pair {
    i: usize,
    j: usize,
    gain: f64,
}

/// The maximal violator among the points that may go up, and the partner of the largest
/// second-order gain; `None` when no pair violates the optimality conditions beyond rounding.
fn choose_pair(state: &State<'_>, rows: &mut KernelRows) -> Option<Pair> {
    let points = &state.problem.points;
    let mut best: Option<(usize, f64)> = None;
    for (k, point) in points.iter().enumerate() {
        let may_rise =
            if point.sign > 0.0 { state.alpha[k] < point.penalty } else { state.alpha[k] > 0.0 };
        let value = point.sign * state.violation(k);
        if may_rise && best.is_none_or(|(_, highest)| value > highest) {
            best = Some((k, value));
        }
    }
    let (i, highest) = best?;
    rows.ensure(state.problem, i);
    let row = rows.row(i);
    let own = rows.diagonal(i);
    let threshold = highest - 1e-14 * highest.abs().max(1.0);
    let mut chosen: Option<Pair> = None;
    for (k, point) in points.iter().enumerate() {
        let may_fall =
            if point.sign > 0.0 { state.alpha[k] > 0.0 } else { state.alpha[k] < point.penalty };
        let value = point.sign * state.violation(k);
        if !may_fall || value >= threshold {
            continue;
        }
        let curvature = (own + rows.diagonal(k) - 2.0 * row[k]).max(CURVATURE_FLOOR);
        let gain = (highest - value).powi(2) / curvature;
        if chosen.as_ref().is_none_or(|best| gain > best.gain) {
            chosen = Some(Pair { i, j: k, gain });
        }
    }
    chosen
}

/// Duplicates of opposite class have no curvature between them: the step runs to the bound.
const CURVATURE_FLOOR: f64 = 1e-12;

fn most_misaligned(state: &State<'_>) -> (usize, f64) {
    let mut best = (0, 0.0);
    for (k, point) in state.problem.points.iter().enumerate() {
        if state.alpha[k] > 0.0 && point.is_uncertain() {
            let gain = state.misalignment(k);
            if gain > best.1 {
                best = (k, gain);
            }
        }
    }
    best
}

/// What a step adds at one point: weight cα and displacement S v.
#[derive(Debug, Clone, Copy, Default)]
struct Change {
    a: f64,
    s: Vector3,
}

/// One of the points being moved, with its own copy of everything that the move changes.
struct Local<'a> {
    problem: &'a Problem,
    index: usize,
    alpha: f64,
    p: Vector3,
    f: f64,
    gradient: Vector3,
    change: Change,
}

impl<'a> Local<'a> {
    fn new(state: &State<'a>, index: usize) -> Self {
        Self {
            problem: state.problem,
            index,
            alpha: state.alpha[index],
            p: state.p[index],
            f: state.f[index],
            gradient: state.gradient[index],
            change: Change::default(),
        }
    }

    /// Adds the influence of a change at `source`, `k` being the kernel value of the two points.
    fn feel(&mut self, source: &Local<'_>, k: f64, a: f64, s: &Vector3) {
        let from = &self.problem.points[source.index].x;
        let to = &self.problem.points[self.index].x;
        let (df, dg) = self.problem.kernel.influence(from, to, k, a, s);
        self.f += df;
        self.gradient += dg;
    }

    fn feel_itself(&mut self, a: f64, s: &Vector3) {
        let x = &self.problem.points[self.index].x;
        let (df, dg) = self.problem.kernel.influence(x, x, self.problem.kernel.value(x, x), a, s);
        self.f += df;
        self.gradient += dg;
        self.change.a += a;
        self.change.s += s;
    }

    /// Moves p to the best place in its ball and returns the change of the displacement.
    fn ball_step(&mut self) -> Vector3 {
        let point = &self.problem.points[self.index];
        if self.alpha == 0.0 || !point.is_uncertain() {
            return Vector3::zeros();
        }
        let m = point.t.component_mul(&point.t) * self.problem.kernel.self_curvature();
        let h = (m.component_mul(&self.p) - point.factor * self.gradient)
            .zip_map(&point.t, |h, t| if t > 0.0 { h } else { 0.0 });
        let p = ball_minimiser(&m, &h, self.alpha);
        let s = point.displacement(&(p - self.p));
        self.p = p;
        self.feel_itself(0.0, &s);
        s
    }

    /// The direction u of the cone vector that scales with α: its own, or against the gradient for
    /// a point that enters.
    fn direction(&self) -> Vector3 {
        let point = &self.problem.points[self.index];
        if !point.is_uncertain() {
            return Vector3::zeros();
        }
        if self.alpha > 0.0 {
            return self.p / self.alpha;
        }
        let g = point.factor * self.gradient;
        let norm = g.norm();
        if norm > 0.0 { g / -norm } else { Vector3::zeros() }
    }
}

/// The exact step along (α_i, α_j) += (c_i, −c_j)·δ with both directions u fixed; false when it is 0.
fn pair_step(first: &mut Local<'_>, second: &mut Local<'_>, k: f64) -> bool {
    let problem = first.problem;
    let (pi, pj) = (&problem.points[first.index], &problem.points[second.index]);
    let (ui, uj) = (first.direction(), second.direction());
    // Per unit of δ: weight +1 and −1, displacement c·Tᵀu.
    let (si, sj) = (pi.displacement(&ui) * pi.sign, pj.displacement(&uj) * -pj.sign);
    let kernel = &problem.kernel;
    let of = |from: &Vector3, to: &Vector3, k: f64, a: f64, s: &Vector3| {
        kernel.influence(from, to, k, a, s)
    };
    let own = |x: &Vector3, a: f64, s: &Vector3| of(x, x, kernel.value(x, x), a, s);
    let (own_i, own_j) = (own(&pi.x, 1.0, &si), own(&pj.x, -1.0, &sj));
    let (at_i, at_j) = (of(&pj.x, &pi.x, k, -1.0, &sj), of(&pi.x, &pj.x, k, 1.0, &si));
    let (fi, gi) = (own_i.0 + at_i.0, own_i.1 + at_i.1);
    let (fj, gj) = (own_j.0 + at_j.0, own_j.1 + at_j.1);
    let curvature = (fi + si.dot(&gi) - fj + sj.dot(&gj)).max(CURVATURE_FLOOR);
    let slope = pi.sign
        - first.f
        - si.dot(&first.gradient)
        - (pj.sign - second.f + sj.dot(&second.gradient));
    // α_i moves by c_i δ and α_j by −c_j δ; both stay in their boxes.
    let range = |sign: f64, alpha: f64, penalty: f64| {
        if sign > 0.0 { (-alpha, penalty - alpha) } else { (alpha - penalty, alpha) }
    };
    let (low_i, high_i) = range(pi.sign, first.alpha, pi.penalty);
    let (low_j, high_j) = range(-pj.sign, second.alpha, pj.penalty);
    let delta = (slope / curvature).max(low_i.max(low_j)).min(high_i.min(high_j));
    if delta == 0.0 || !delta.is_finite() {
        return false;
    }
    let (si, sj) = (si * delta, sj * delta);
    move_to(first, pi.penalty, pi.sign * delta, &ui);
    move_to(second, pj.penalty, -pj.sign * delta, &uj);
    first.feel_itself(delta, &si);
    second.feel_itself(-delta, &sj);
    let (df_i, dg_i) = of(&pj.x, &pi.x, k, -delta, &sj);
    let (df_j, dg_j) = of(&pi.x, &pj.x, k, delta, &si);

    first.f += df_i;
    first.gradient += dg_i;
    second.f += df_j;
    second.gradient += dg_j;
    true
}

fn move_to(local: &mut Local<'_>, penalty: f64, by: f64, direction: &Vector3) {
    // Rounding must not leave a point a hair off its bound: it would count as free.
    let mut alpha = (local.alpha + by).clamp(0.0, penalty);
    if alpha < 1e-15 * penalty.min(by.abs().max(local.alpha)) {
        alpha = 0.0;
    } else if penalty - alpha < 1e-15 * penalty {
        alpha = penalty;
    }
    local.alpha = alpha;
    local.p = direction * alpha;
}

/// Writes one or two moved points back and carries their changes to all points.
///
/// Where no point is uncertain nothing asks for gradients before the end, when they are computed
/// anew.
fn commit(state: &mut State<'_>, rows: &KernelRows, first: &Local<'_>, second: Option<&Local<'_>>) {
    let problem = state.problem;
    for local in [Some(first), second].into_iter().flatten() {
        state.alpha[local.index] = local.alpha;
        state.p[local.index] = local.p;
        if !problem.has_uncertain {
            for (f, k) in state.f.iter_mut().zip(rows.row(local.index)) {
                *f += k * local.change.a;
            }
            continue;
        }
        let source = &problem.points[local.index].x;
        let row = rows.row(local.index);
        for (k, point) in problem.points.iter().enumerate() {
            let (df, dg) =
                problem.kernel.influence(source, &point.x, row[k], local.change.a, &local.change.s);
            state.f[k] += df;
            state.gradient[k] += dg;
        }
    }
    if problem.has_uncertain {
        for (k, point) in problem.points.iter().enumerate() {
            state.norm[k] = scaled_norm(point, &state.gradient[k]);
        }
    }
}
