//! One or two points being moved, apart from all others.

use cloudtouch_geom::Vector3;

use crate::problem::Problem;
use crate::smo::ball::ball_minimiser;
use crate::smo::state::State;

/// How much further than to the best place along their line a pair is moved. As in over-relaxation that takes
/// fewer steps where the next ones undo part of what this one does; it still gains 0.84 of what it could.
const FURTHER: f64 = 1.4;

/// What a step adds at one point: weight cα and displacement S v.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Change {
    pub(crate) a: f64,
    pub(crate) s: Vector3,
}

/// One of the points being moved, with its own copy of everything that the move changes.
pub(crate) struct Local<'a> {
    problem: &'a Problem,
    pub(crate) index: usize,
    pub(crate) alpha: f64,
    pub(crate) p: Vector3,
    f: f64,
    gradient: Vector3,
    pub(crate) change: Change,
}

impl<'a> Local<'a> {
    /// A copy of what the state says of a point.
    pub(crate) fn new(state: &State<'a>, index: usize) -> Self {
        Self {
            problem: state.problem,
            index,
            alpha: state.numbers.alpha.at(index),
            p: state.numbers.p(index),
            f: state.numbers.field.f.at(index),
            gradient: state.numbers.field.gradient_at(index),
            change: Change::default(),
        }
    }

    /// Adds the influence of a displacement at `source`, `k` being the reduced kernel of the two points.
    pub(crate) fn feel(&mut self, source: &Local<'_>, k: f64, s: &Vector3) {
        let from = &self.problem.points[source.index].x;
        let to = &self.problem.points[self.index].x;
        let (df, dg) = self.problem.kernel.influence(from, to, k, 0.0, s);
        self.f += df;
        self.gradient += dg;
    }

    /// Moves p to the best place in its ball and returns the change of the displacement.
    pub(crate) fn ball_step(&mut self) -> Vector3 {
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
        let (df, dg) = self.problem.kernel.own_influence(&point.x, 0.0, &s);
        self.f += df;
        self.gradient += dg;
        self.change.s += s;
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

/// The step along (α_i, α_j) += (c_i, −c_j)·δ with both directions u fixed; false when it is 0.
///
/// It is the last of what moves the two: what it does to f₀ and the gradient there is left to be
/// carried to them with all others.
pub(crate) fn pair_step(first: &mut Local<'_>, second: &mut Local<'_>, k: f64) -> bool {
    let problem = first.problem;
    let (pi, pj) = (&problem.points[first.index], &problem.points[second.index]);
    let (ui, uj) = (first.direction(), second.direction());
    // Per unit of δ: weight +1 and −1, displacement c·Tᵀu.
    let (si, sj) = (pi.displacement(&ui) * pi.sign, pj.displacement(&uj) * -pj.sign);
    let kernel = &problem.kernel;
    let of = |from: &Vector3, to: &Vector3, k: f64, a: f64, s: &Vector3| {
        kernel.influence(from, to, k, a, s)
    };
    let (own_i, own_j) =
        (kernel.own_influence(&pi.x, 1.0, &si), kernel.own_influence(&pj.x, -1.0, &sj));
    let (at_i, at_j) = (of(&pj.x, &pi.x, k, -1.0, &sj), of(&pi.x, &pj.x, k, 1.0, &si));
    let (fi, gi) = (own_i.0 + at_i.0, own_i.1 + at_i.1);
    let (fj, gj) = (own_j.0 + at_j.0, own_j.1 + at_j.1);
    let parts = [fi, si.dot(&gi), -fj, sj.dot(&gj)];
    // What the parts cancel to within their rounding is none; the step then runs to a bound.
    let rounding = 4.0 * f64::EPSILON * parts.iter().map(|part| part.abs()).sum::<f64>();
    let curvature = parts.iter().sum::<f64>().max(rounding).max(f64::MIN_POSITIVE);
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
    let delta = (FURTHER * slope / curvature).max(low_i.max(low_j)).min(high_i.min(high_j));
    if delta == 0.0 || !delta.is_finite() {
        return false;
    }
    move_to(first, pi.penalty, pi.sign * delta, &ui);
    move_to(second, pj.penalty, -pj.sign * delta, &uj);
    first.change = Change { a: delta, s: first.change.s + si * delta };
    second.change = Change { a: -delta, s: second.change.s + sj * delta };
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
