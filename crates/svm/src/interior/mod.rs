//! Rung 2: a dense primal-dual interior point method on the dual (eq. 13).
//!
//! Mehrotra's predictor and corrector with Nesterov–Todd scaling. Writing z_i = (α_i, p_i) in its
//! cone with multiplier s_i, u_i = C_i − α_i ≥ 0 with multiplier ξ_i, and the bias b for Σcα = 0:
//! Q z − e − s + ξ + b c = 0. Every iterate is feasible, so its gap can be certified.

pub(crate) mod active;
mod cone;
pub(crate) mod gram;
mod newton;

use cloudtouch_geom::Vector3;
use nalgebra::Vector4;

use crate::certificate::slack::Slack;
use crate::certificate::{Certificate, Margin, certify, largest_violation};
use crate::interior::cone::{Scaling, longest_step, product, quotient};
use crate::interior::newton::Newton;
use crate::problem::Problem;
use crate::smo::ball::clip_to_ball;
use crate::smo::state::Dual;
use crate::status::{Rung, Status};
use crate::watch::Watch;

/// Seven to twelve iterations are usual at 1e-4; past this rounding has stopped the progress.
const MAX_ITERATIONS: usize = 60;
/// An iteration without a smaller gap counts as stalled only once the gap has fallen to this: until
/// then multipliers that have to grow to a large penalty leave it near 1 while all goes well.
const NEAR: f64 = 0.1;
/// Stalled iterations after which rounding has stopped the progress.
const MAX_STALLED: usize = 5;
/// Share of the way to the boundary that a step goes.
const STEP: f64 = 0.99;

/// Multipliers start from at least this over the squared reach of the samples in feature space, where
/// penalties allow it: two classes so far apart take multipliers of 2 over their squared distance.
const START: f64 = 10.0;

/// Beyond this relative gap a dual point is no start: its multipliers are of the wrong size.
pub(crate) const FAR: f64 = 0.4;
/// A start beside a dual point that has not led to the tolerance by then leads nowhere.
const NEAR_ITERATIONS: usize = 15;
/// Products with s and ξ that the start beside a dual point has at least, over the mean of the gap.
/// Larger ones are better centred, but further from what SMO has found.
const LEVEL: f64 = 0.02;
/// And the share of the penalty that it keeps from a bound at most.
const MARGIN: f64 = 0.1;
/// How far inside of its cone a multiplier starts at least, as a share of it.
const LEAST_INSIDE: f64 = 1e-3;

/// The iterate: one cone pair and one bound pair for each point.
struct Iterate<'a> {
    problem: &'a Problem,
    z: Vec<Vector4<f64>>,
    s: Vec<Vector4<f64>>,
    u: Vec<f64>,
    xi: Vec<f64>,
    bias: f64,
    /// Q z.
    moved: Vec<Vector4<f64>>,
    scalings: Vec<Scaling>,
}

/// A step of the iterate.
#[derive(Default)]
struct Direction {
    z: Vec<Vector4<f64>>,
    s: Vec<Vector4<f64>>,
    xi: Vec<f64>,
    bias: f64,
}

/// How far the method came.
pub(crate) struct Reached {
    /// The best multipliers and cone vectors found; none where not even the first were finite.
    pub(crate) duals: Option<Vec<Dual>>,
    pub(crate) iterations: usize,
    pub(crate) status: Status,
}

/// Solves the dual to `relative_gap`, or as far as rounding and `allowed` iterations let it.
///
/// It starts beside a dual point, that of SMO, or, where that is far from the optimum or leads nowhere,
/// cold.
pub(crate) fn solve(
    problem: &Problem,
    so_far: &[Dual],
    relative_gap: f64,
    allowed: usize,
    watch: &mut Watch<'_>,
) -> Reached {
    let Some(mut newton) = Newton::of(problem) else {
        return Reached { duals: None, iterations: 0, status: Status::TooLarge };
    };
    let mut slack = Slack::default();
    let mut run = Run { best: None, iterations: 0 };
    if let Some(near) = Iterate::near(problem, so_far, &mut newton, &mut slack) {
        let allowed = allowed.min(NEAR_ITERATIONS);
        let status = run.go_on(near, &mut newton, &mut slack, relative_gap, allowed, watch);
        if matches!(status, Status::Converged | Status::Cancelled) {
            return run.end(status);
        }
    }
    let reaches = problem.points.iter().map(|p| problem.kernel.squared_reach(&p.x));
    let least = (START / reaches.fold(0.0, f64::max)).min(f64::MAX);
    // Where SMO got stuck its multipliers are of the right size, if nothing more: an iteration changes
    // them by a bounded factor, so that large penalties take many from a small start.
    let sum: f64 = so_far.iter().map(|(alpha, _)| alpha).sum();
    let start = Iterate::start(problem, least.max(sum / problem.len() as f64));
    let allowed = (run.iterations + MAX_ITERATIONS).min(allowed);
    let status = run.go_on(start, &mut newton, &mut slack, relative_gap, allowed, watch);
    run.end(status)
}

/// The iterations so far, and the best multipliers among them with their gap.
struct Run {
    best: Option<(Vec<Vector4<f64>>, f64)>,
    iterations: usize,
}

impl Run {
    /// Iterates from a start, and says how that ended.
    fn go_on(
        &mut self,
        mut at: Iterate<'_>,
        newton: &mut Newton,
        slack: &mut Slack,
        relative_gap: f64,
        allowed: usize,
        watch: &mut Watch<'_>,
    ) -> Status {
        let (mut least, mut worse) = (f64::INFINITY, 0);
        while self.iterations < allowed {
            newton.product(&at.z, &mut at.moved);
            let certificate = at.certificate(slack);
            let gap = certificate.relative_gap();
            let violation = || largest_violation(&at.problem.points, |i| at.violation(i));
            let stop =
                watch.shows_stop(Rung::InteriorPoint, self.iterations, &certificate, violation);
            if gap.is_finite() && self.best.as_ref().is_none_or(|(_, least)| gap < *least) {
                self.best = Some((at.z.clone(), gap));
            }
            if gap <= relative_gap {
                return Status::Converged;
            }
            // An earlier run does not count: it may have come closer before it stalled.
            worse = if gap < least { 0 } else { worse + 1 };
            least = least.min(gap);
            if stop {
                return Status::Cancelled;
            }
            // A scaling or a factor that fails is rounding too.
            if worse >= MAX_STALLED && least <= NEAR || at.step(newton).is_none() {
                return Status::Stalled;
            }
            self.iterations += 1;
        }
        Status::IterationLimit
    }

    fn end(self, status: Status) -> Reached {
        let duals = self.best.map(|(z, _)| z.iter().map(|z| (z[0], tail(z))).collect());
        let nothing = duals.is_none() && status == Status::Stalled;
        let status = if nothing { Status::NotFinite } else { status };
        Reached { duals, iterations: self.iterations, status }
    }
}

impl<'a> Iterate<'a> {
    /// Multipliers of about `size` and well inside their range with Σcα = 0, cone vectors 0.
    fn start(problem: &'a Problem, size: f64) -> Self {
        let points = &problem.points;
        let first = |penalty: f64| (0.5 * penalty).min(size);
        let total = |sign: f64| -> f64 {
            points.iter().filter(|p| p.sign == sign).map(|p| first(p.penalty)).sum()
        };
        let (a, b) = (total(1.0), total(-1.0));
        let lighter = a.min(b);
        let alpha: Vec<f64> = points
            .iter()
            .map(|p| first(p.penalty) * lighter / if p.sign > 0.0 { a } else { b })
            .collect();
        Self {
            problem,
            z: alpha.iter().map(|a| head(*a)).collect(),
            s: vec![head(1.0); points.len()],
            u: points.iter().zip(&alpha).map(|(p, a)| p.penalty - a).collect(),
            xi: vec![1.0; points.len()],
            bias: 0.0,
            moved: vec![Vector4::zeros(); points.len()],
            scalings: Vec::with_capacity(points.len()),
        }
    }

    /// Well inside the cones beside a dual point that is not far from the optimum, with s, ξ and b that
    /// leave nothing of Q z − e − s + ξ + b c; `None` when it is far.
    ///
    /// With b and the excesses y − cb of the certificate, ξ = (y − cb)₊ + δ and
    /// s = (|g| + (y − cb)₋ + δ, g) do: complementarity is then the gap and δΣC.
    fn near(
        problem: &'a Problem,
        so_far: &[Dual],
        newton: &mut Newton,
        slack: &mut Slack,
    ) -> Option<Self> {
        let points = &problem.points;
        let mut at = Self::start(problem, 1.0);
        for (z, (alpha, p)) in at.z.iter_mut().zip(so_far) {
            *z = Vector4::new(*alpha, p.x, p.y, p.z);
        }
        newton.product(&at.z, &mut at.moved);
        let certificate = at.certificate(slack);
        if certificate.relative_gap() > FAR {
            return None;
        }
        let penalties: f64 = points.iter().map(|p| p.penalty).sum();
        let level = LEVEL * certificate.gap / (2 * points.len()) as f64;
        let floor = certificate.gap / penalties;
        let mut totals = [0.0; 2];
        for (i, point) in points.iter().enumerate() {
            let (norm, excess) = at.excess(i, certificate.bias);
            let [above, below] = [excess, -excess].map(|e| e.max(0.0) + floor);
            let off = |slack: f64| (level / slack).min(MARGIN * point.penalty);
            let alpha = at.z[i][0].max(off(below)).min(point.penalty - off(above));
            let inside = (below / (below + norm)).clamp(LEAST_INSIDE, 0.5);
            let p = clip_to_ball(&tail(&at.z[i]), alpha * (1.0 - inside));
            at.z[i] = Vector4::new(alpha, p.x, p.y, p.z);
            totals[usize::from(point.sign < 0.0)] += alpha;
        }
        let lighter = totals[0].min(totals[1]);
        for (i, point) in points.iter().enumerate() {
            at.z[i] *= lighter / totals[usize::from(point.sign < 0.0)];
            at.u[i] = point.penalty - at.z[i][0];
        }
        newton.product(&at.z, &mut at.moved);
        let certificate = at.certificate(slack);
        let floor = certificate.gap / penalties;
        at.bias = certificate.bias;
        for i in 0..points.len() {
            let (norm, excess) = at.excess(i, certificate.bias);
            let [above, below] = [excess, -excess].map(|e| e.max(0.0) + floor);
            at.s[i] = at.moved[i];
            at.s[i][0] = norm + below;
            at.xi[i] = above;
        }
        Some(at)
    }

    /// |T∇f₀| and y − cb.
    fn excess(&self, i: usize, bias: f64) -> (f64, f64) {
        let norm = tail(&self.moved[i]).norm();
        (norm, 1.0 - self.moved[i][0] + norm - self.problem.points[i].sign * bias)
    }

    /// Of these multipliers as they are: every iterate keeps Σcα = 0 up to rounding.
    fn certificate(&self, slack: &mut Slack) -> Certificate {
        certify(&self.problem.points, slack, |i| {
            let (z, moved) = (&self.z[i], &self.moved[i]);
            let turned = z.dot(moved) - z[0] * moved[0];
            Margin { alpha: z[0], value: moved[0], norm: tail(moved).norm(), turned }
        })
    }

    /// α and y.
    fn violation(&self, i: usize) -> (f64, f64) {
        (self.z[i][0], 1.0 - self.moved[i][0] + tail(&self.moved[i]).norm())
    }

    /// One predictor-corrector step; `None` when rounding stops it.
    fn step(&mut self, newton: &mut Newton) -> Option<()> {
        let n = self.z.len();
        self.scalings.clear();
        for (z, s) in self.z.iter().zip(&self.s) {
            self.scalings.push(Scaling::of(z, s)?);
        }
        newton.factor(&self.scalings, |i| self.xi[i] / self.u[i])?;
        let pairs = (0..n).map(|i| self.z[i].dot(&self.s[i]) + self.u[i] * self.xi[i]);
        let complementarity = pairs.sum::<f64>() / (2 * n) as f64;
        let square = |i: usize| product(&self.scalings[i].lambda, &self.scalings[i].lambda);
        let predictor = self.direction(newton, |i| -square(i), |i| -self.u[i] * self.xi[i])?;
        let target = complementarity * (1.0 - self.longest(&predictor)).powi(3);
        let cone = |i: usize| {
            let (w, z, s) = (&self.scalings[i], &predictor.z[i], &predictor.s[i]);
            head(target) - square(i) - product(&w.apply_inverse(s), &w.apply(z))
        };
        let bound =
            |i: usize| target - self.u[i] * self.xi[i] + predictor.z[i][0] * predictor.xi[i];
        let corrected = self.direction(newton, cone, bound)?;
        let length = STEP * self.longest(&corrected);
        for i in 0..n {
            self.z[i] += corrected.z[i] * length;
            self.s[i] += corrected.s[i] * length;
            self.u[i] -= corrected.z[i][0] * length;
            self.xi[i] += corrected.xi[i] * length;
        }
        self.bias += corrected.bias * length;
        (length > 1e-10).then_some(())
    }

    /// Where λ∘(W dz + W⁻¹ ds) is `cone`, u dξ + ξ du is `bound`, and nothing is left of
    /// Q z − e − s + ξ + b c; `None` when that is not finite.
    fn direction(
        &self,
        newton: &mut Newton,
        cone: impl Fn(usize) -> Vector4<f64>,
        bound: impl Fn(usize) -> f64,
    ) -> Option<Direction> {
        let points = &self.problem.points;
        let n = points.len();
        let bounds: Vec<f64> = (0..n).map(bound).collect();
        let pushed: Vec<Vector4<f64>> = self
            .scalings
            .iter()
            .enumerate()
            .map(|(i, scaling)| scaling.apply(&quotient(&scaling.lambda, &cone(i))))
            .collect();
        let right = |i: usize| {
            let mut right = pushed[i] - self.moved[i] + self.s[i];
            right[0] += 1.0 - self.xi[i] - self.bias * points[i].sign - bounds[i] / self.u[i];
            right
        };
        let (z, bias) = newton.solve(right);
        let s = (0..n).map(|i| pushed[i] - self.scalings[i].apply_squared(&z[i])).collect();
        let xi = (0..n).map(|i| (bounds[i] + self.xi[i] * z[i][0]) / self.u[i]).collect();
        let finite = bias.is_finite() && z.iter().all(|z| z.iter().all(|v| v.is_finite()));
        finite.then_some(Direction { z, s, xi, bias })
    }

    /// The longest step, at most 1, that leaves everything in its cone.
    fn longest(&self, along: &Direction) -> f64 {
        let ratio = |value: f64, change: f64| if change < 0.0 { -value / change } else { 1.0 };
        (0..self.z.len())
            .map(|i| {
                longest_step(&self.z[i], &along.z[i])
                    .min(longest_step(&self.s[i], &along.s[i]))
                    .min(ratio(self.u[i], -along.z[i][0]))
                    .min(ratio(self.xi[i], along.xi[i]))
            })
            .fold(1.0, f64::min)
    }
}

fn head(value: f64) -> Vector4<f64> {
    Vector4::new(value, 0.0, 0.0, 0.0)
}

fn tail(vector: &Vector4<f64>) -> Vector3 {
    Vector3::new(vector[1], vector[2], vector[3])
}
