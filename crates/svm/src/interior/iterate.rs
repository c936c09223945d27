//! Where the method is, and where it starts: cold, or beside a dual point.

use cloudtouch_geom::Vector3;
use nalgebra::Vector4;

use crate::certificate::slack::Slack;
use crate::certificate::{Certificate, Margin, certify};
use crate::interior::cone::Scaling;
use crate::interior::newton::Newton;
use crate::problem::Problem;
use crate::smo::ball::clip_to_ball;
use crate::smo::state::Dual;

/// Multipliers start from at least this over the squared reach of the samples in feature space, where
/// penalties allow it: two classes so far apart take multipliers of 2 over their squared distance.
const START: f64 = 10.0;

/// Beyond this relative gap a dual point is no start: its multipliers are of the wrong size.
pub(crate) const FAR: f64 = 0.4;
/// Products with s and ξ that the start beside a dual point has at least, over the mean of the gap.
/// Larger ones are better centred, but further from what SMO has found.
const LEVEL: f64 = 0.02;
/// And the share of the penalty that it keeps from a bound at most.
const MARGIN: f64 = 0.1;
/// How far inside of its cone a multiplier starts at least, as a share of it.
const LEAST_INSIDE: f64 = 1e-3;

/// The iterate: one cone pair and one bound pair for each point.
pub(super) struct Iterate<'a> {
    pub(super) problem: &'a Problem,
    pub(super) z: Vec<Vector4<f64>>,
    pub(super) s: Vec<Vector4<f64>>,
    pub(super) u: Vec<f64>,
    pub(super) xi: Vec<f64>,
    pub(super) bias: f64,
    /// Q z.
    pub(super) moved: Vec<Vector4<f64>>,
    pub(super) scalings: Vec<Scaling>,
}

impl<'a> Iterate<'a> {
    /// Far from any dual point.
    pub(super) fn cold(problem: &'a Problem, so_far: &[Dual]) -> Self {
        let reaches = problem.points.iter().map(|p| problem.kernel.squared_reach(&p.x));
        let least = (START / reaches.fold(0.0, f64::max)).min(f64::MAX);
        // Where SMO gave up its multipliers still grow, towards the penalties at most. An iteration changes
        // them by a bounded factor: a start between the two takes fewest.
        let n = problem.len() as f64;
        let reached = so_far.iter().map(|(alpha, _)| alpha).sum::<f64>() / n;
        let penalty = problem.points.iter().map(|p| p.penalty).sum::<f64>() / n;
        Self::start(problem, least.max(reached.sqrt() * penalty.sqrt()))
    }

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
    pub(super) fn near(
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
    pub(super) fn certificate(&self, slack: &mut Slack) -> Certificate {
        let violation = |i: usize| self.violation(i).1;
        certify(&self.problem.points, slack, violation, |i| {
            let (z, moved) = (&self.z[i], &self.moved[i]);
            let turned = z.dot(moved) - z[0] * moved[0];
            Margin { alpha: z[0], value: moved[0], norm: tail(moved).norm(), turned }
        })
    }

    /// α and y.
    pub(super) fn violation(&self, i: usize) -> (f64, f64) {
        (self.z[i][0], 1.0 - self.moved[i][0] + tail(&self.moved[i]).norm())
    }
}

pub(super) fn head(value: f64) -> Vector4<f64> {
    Vector4::new(value, 0.0, 0.0, 0.0)
}

pub(super) fn tail(vector: &Vector4<f64>) -> Vector3 {
    Vector3::new(vector[1], vector[2], vector[3])
}
