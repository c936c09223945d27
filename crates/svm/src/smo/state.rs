//! A dual point with the decision function it induces at the samples, and its duality gap.

use cloudtouch_geom::Vector3;

use crate::certificate::slack::Slack;
use crate::certificate::{Certificate, Margin, certify, largest_violation};
use crate::lanes::Lanes;
use crate::problem::Problem;
use crate::smo::ball::clip_to_ball;
use crate::smo::rows::KernelRows;
use crate::smo::spread::{Field, Source};

/// α and p of a sample: the cone vector in the eigenbasis of its covariance, |p| ≤ α.
pub(crate) type Dual = (f64, Vector3);

/// Dual variables and, kept in step with them, f₀ and its gradient at every sample.
#[derive(Debug)]
pub(crate) struct State<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) numbers: Numbers,
}

/// The numbers of a [`State`], one entry a sample; kept from solve to solve for their memory.
#[derive(Debug, Default)]
pub(crate) struct Numbers {
    pub(crate) alpha: Lanes,
    /// Dual vectors in the eigenbasis of each covariance, |p| ≤ α.
    p: [Lanes; 3],
    pub(crate) field: Field,
    slack: Slack,
}

impl Numbers {
    pub(crate) fn p(&self, i: usize) -> Vector3 {
        Vector3::from_fn(|axis, _| self.p[axis].at(i))
    }

    pub(crate) fn p_lanes(&self) -> &[Lanes; 3] {
        &self.p
    }

    /// Moves the dual variables of a sample; what they induce stays.
    pub(crate) fn put(&mut self, i: usize, alpha: f64, p: &Vector3) {
        self.alpha.put(i, alpha);
        for axis in 0..3 {
            self.p[axis].put(i, p[axis]);
        }
    }
}

impl<'a> State<'a> {
    /// The dual point 0, in the memory of `numbers`.
    pub(crate) fn cold(problem: &'a Problem, mut numbers: Numbers) -> Self {
        let n = problem.len();
        numbers.alpha.reset(n);
        numbers.p.iter_mut().for_each(|lanes| lanes.reset(n));
        numbers.field.reset(n);
        Self { problem, numbers }
    }

    /// The nearest feasible point found by clipping to the box and the cones, then shrinking the
    /// heavier class until Σcα = 0. Values that are not finite become 0.
    pub(crate) fn from_duals(
        problem: &'a Problem,
        numbers: Numbers,
        duals: impl IntoIterator<Item = Dual>,
        rows: &mut KernelRows,
    ) -> Self {
        let mut state = Self::cold(problem, numbers);
        let numbers = &mut state.numbers;
        let mut totals = [0.0; 2];
        for (i, (alpha, p)) in duals.into_iter().enumerate().take(problem.len()) {
            let point = &problem.points[i];
            let alpha = if alpha.is_finite() { alpha.clamp(0.0, point.penalty) } else { 0.0 };
            totals[usize::from(point.sign < 0.0)] += alpha;
            let has_cone = point.is_uncertain() && p.iter().all(|v| v.is_finite());
            let p = p.zip_map(&point.t, |p, t| if has_cone && t > 0.0 { p } else { 0.0 });
            numbers.put(i, alpha, &p);
        }
        let lighter = totals[0].min(totals[1]);
        let shrink = totals.map(|total| if total > lighter { lighter / total } else { 1.0 });
        for (i, point) in problem.points.iter().enumerate() {
            let factor = shrink[usize::from(point.sign < 0.0)];
            let alpha = numbers.alpha.at(i) * factor;
            let p = clip_to_ball(&(numbers.p(i) * factor), alpha);
            numbers.put(i, alpha, &p);
        }
        state.recompute(rows);
        state
    }

    /// A copy of the dual point.
    pub(crate) fn copied(&self, rows: &mut KernelRows) -> Self {
        let duals = (0..self.problem.len()).map(|i| self.dual(i));
        Self::from_duals(self.problem, Numbers::default(), duals, rows)
    }

    pub(crate) fn dual(&self, i: usize) -> Dual {
        (self.numbers.alpha.at(i), self.numbers.p(i))
    }

    /// Computes f₀ and its gradient from the dual variables alone.
    pub(crate) fn recompute(&mut self, rows: &mut KernelRows) {
        let problem = self.problem;
        self.numbers.field.reset(problem.len());
        for (i, point) in problem.points.iter().enumerate() {
            let alpha = self.numbers.alpha.at(i);
            if alpha == 0.0 {
                continue;
            }
            rows.ensure(problem, i);
            let (a, s) = (point.sign * alpha, point.displacement(&self.numbers.p(i)));
            let source = Source { x: point.x, row: rows.row(i), a, s };
            self.numbers.field.add(problem, &[source], true);
        }
    }

    /// y = 1 − c f₀ + |T∇f₀|: how far the worst point of the ellipsoid is inside the margin, b aside.
    #[inline]
    pub(crate) fn violation(&self, i: usize) -> f64 {
        self.numbers.field.violation(self.problem.points[i].sign, i)
    }

    /// y − cb: how far the worst point of the ellipsoid is inside the margin with this bias.
    pub(crate) fn excess(&self, i: usize, bias: f64) -> f64 {
        self.violation(i) - self.problem.points[i].sign * bias
    }

    /// α|T∇f₀| + p·T∇f₀: what a cone vector, turned against the gradient, gains about.
    #[inline]
    pub(crate) fn misalignment(&self, i: usize) -> f64 {
        let Numbers { alpha, p, field, .. } = &self.numbers;
        alpha.at(i) * field.norm.at(i) + turned(p, field, i)
    }

    /// Objective values and gap, from the f₀ and gradients at hand.
    pub(crate) fn certificate(&mut self) -> Certificate {
        let Numbers { alpha, p, field, slack } = &mut self.numbers;
        let points = &self.problem.points;
        let violation = |i: usize| field.violation(points[i].sign, i);
        certify(points, slack, violation, |i| Margin {
            alpha: alpha.at(i),
            value: points[i].sign * field.f.at(i),
            norm: field.norm.at(i),
            turned: turned(p, field, i),
        })
    }

    /// The biases that the gap of the last certificate, handed in, cannot tell apart.
    pub(crate) fn bias_interval(&self, certificate: &Certificate) -> [f64; 2] {
        self.numbers.slack.within(certificate.gap, certificate.bias)
    }

    /// By how much the optimality conditions are missed.
    pub(crate) fn largest_violation(&self) -> f64 {
        let at = |i: usize| (self.numbers.alpha.at(i), self.violation(i));
        largest_violation(&self.problem.points, at)
    }
}

/// p·T∇f₀ of a sample.
#[inline]
fn turned(p: &[Lanes; 3], field: &Field, i: usize) -> f64 {
    (0..3).map(|axis| p[axis].at(i) * field.scaled[axis].at(i)).sum()
}
