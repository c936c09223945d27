//! A dual point with the decision function it induces at the samples, and its duality gap.

use cloudtouch_geom::Vector3;

use crate::ball::clip_to_ball;
use crate::bias::Slack;
use crate::problem::{PreparedPoint, Problem};

/// Dual variables and, kept in step with them, f₀ and its gradient at every sample.
#[derive(Debug)]
pub(crate) struct State<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) numbers: Numbers,
}

/// The numbers of a [`State`], one entry a sample; kept from solve to solve for their memory.
#[derive(Debug, Default)]
pub(crate) struct Numbers {
    pub(crate) alpha: Vec<f64>,
    /// Dual vectors in the eigenbasis of each covariance, |p| ≤ α.
    pub(crate) p: Vec<Vector3>,
    /// f₀ = f − b at the samples.
    pub(crate) f: Vec<f64>,
    /// ∇f₀ at the samples, world axes.
    pub(crate) gradient: Vec<Vector3>,
    /// |T∇f₀| at the samples.
    pub(crate) norm: Vec<f64>,
    slack: Slack,
}

/// A dual point's certificate of how far it can be from the optimum.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Certificate {
    pub(crate) bias: f64,
    pub(crate) primal: f64,
    pub(crate) dual: f64,
    pub(crate) squared_norm: f64,
    /// primal − dual, as a sum of non-negative terms.
    pub(crate) gap: f64,
}

impl Certificate {
    pub(crate) fn is_finite(&self) -> bool {
        [self.bias, self.primal, self.dual, self.squared_norm, self.gap]
            .iter()
            .all(|v| v.is_finite())
    }

    /// gap / primal, infinite when it cannot be told.
    pub(crate) fn relative_gap(&self) -> f64 {
        if self.is_finite() && self.primal > 0.0 { self.gap / self.primal } else { f64::INFINITY }
    }
}

impl<'a> State<'a> {
    /// The dual point 0, in the memory of `numbers`.
    pub(crate) fn cold(problem: &'a Problem, mut numbers: Numbers) -> Self {
        let n = problem.len();
        for scalars in [&mut numbers.alpha, &mut numbers.f, &mut numbers.norm] {
            scalars.clear();
            scalars.resize(n, 0.0);
        }
        for vectors in [&mut numbers.p, &mut numbers.gradient] {
            vectors.clear();
            vectors.resize(n, Vector3::zeros());
        }
        Self { problem, numbers }
    }

    /// The nearest feasible point found by clipping to the box and the cones, then shrinking the
    /// heavier class until Σcα = 0. Values that are not finite become 0.
    pub(crate) fn from_duals(
        problem: &'a Problem,
        numbers: Numbers,
        alpha: impl IntoIterator<Item = f64>,
        p: impl IntoIterator<Item = Vector3>,
    ) -> Self {
        let mut state = Self::cold(problem, numbers);
        let numbers = &mut state.numbers;
        let mut totals = [0.0; 2];
        for (i, (alpha, p)) in alpha.into_iter().zip(p).enumerate().take(problem.len()) {
            let point = &problem.points[i];
            let value = if alpha.is_finite() { alpha.clamp(0.0, point.penalty) } else { 0.0 };
            numbers.alpha[i] = value;
            totals[usize::from(point.sign < 0.0)] += value;
            if point.is_uncertain() && p.iter().all(|v| v.is_finite()) {
                numbers.p[i] = p.zip_map(&point.t, |p, t| if t > 0.0 { p } else { 0.0 });
            }
        }
        let lighter = totals[0].min(totals[1]);
        let shrink = totals.map(|total| if total > lighter { lighter / total } else { 1.0 });
        for (i, point) in problem.points.iter().enumerate() {
            let factor = shrink[usize::from(point.sign < 0.0)];
            numbers.alpha[i] *= factor;
            numbers.p[i] = clip_to_ball(&(numbers.p[i] * factor), numbers.alpha[i]);
        }
        state.recompute();
        state
    }

    /// A copy of the dual point, in the memory of `numbers`.
    pub(crate) fn copied(&self, numbers: Numbers) -> Self {
        let (alpha, p) = (&self.numbers.alpha, &self.numbers.p);
        Self::from_duals(self.problem, numbers, alpha.iter().copied(), p.iter().copied())
    }

    /// Computes f₀ and its gradient from the dual variables alone.
    pub(crate) fn recompute(&mut self) {
        let kernel = self.problem.kernel;
        let points = &self.problem.points;
        let numbers = &mut self.numbers;
        numbers.f.fill(0.0);
        numbers.gradient.fill(Vector3::zeros());
        for (source, (&alpha, p)) in points.iter().zip(numbers.alpha.iter().zip(&numbers.p)) {
            if alpha == 0.0 {
                continue;
            }
            let (a, s) = (source.sign * alpha, source.displacement(p));
            for (k, target) in points.iter().enumerate() {
                let reduced = kernel.reduced(&source.x, &target.x);
                let (df, dg) = kernel.influence(&source.x, &target.x, reduced, a, &s);
                numbers.f[k] += df;
                numbers.gradient[k] += dg;
            }
        }
        for (k, point) in points.iter().enumerate() {
            numbers.norm[k] = scaled_norm(point, &numbers.gradient[k]);
        }
    }

    /// y = 1 − c f₀ + |T∇f₀|: how far the worst point of the ellipsoid is inside the margin, b aside.
    #[inline]
    pub(crate) fn violation(&self, i: usize) -> f64 {
        1.0 - self.problem.points[i].sign * self.numbers.f[i] + self.numbers.norm[i]
    }

    /// α|g| + p·g ≥ 0: what turning p against the gradient could gain at most.
    #[inline]
    pub(crate) fn misalignment(&self, i: usize) -> f64 {
        let turned = self.turned(i);
        (self.numbers.alpha[i] * self.numbers.norm[i] + turned).max(0.0)
    }

    fn turned(&self, i: usize) -> f64 {
        let point = &self.problem.points[i];
        point.displacement(&self.numbers.p[i]).dot(&self.numbers.gradient[i])
    }

    /// Objective values and gap, from the f₀ and gradients at hand.
    ///
    /// gap = Σ (C−α)(y−cb)₊ + α(y−cb)₋ + (α|g| + p·g), with b the minimiser of Σ C(y−cb)₊.
    pub(crate) fn certificate(&mut self) -> Certificate {
        let points = &self.problem.points;
        let mut slack = std::mem::take(&mut self.numbers.slack);
        slack
            .set((0..points.len()).map(|i| (points[i].sign, self.violation(i), points[i].penalty)));
        let bias = slack.minimiser();
        self.numbers.slack = slack;
        let mut sum = 0.0;
        let mut squared_norm = 0.0;
        let mut slack = 0.0;
        let mut gap = 0.0;
        for (i, point) in points.iter().enumerate() {
            let alpha = self.numbers.alpha[i];
            let excess = self.violation(i) - point.sign * bias;
            let above = excess.max(0.0);
            sum += alpha;
            squared_norm += point.sign * alpha * self.numbers.f[i] + self.turned(i);
            slack += point.penalty * above;
            gap += (point.penalty - alpha) * above + alpha * (above - excess);
            gap += self.misalignment(i);
        }
        let squared_norm = squared_norm.max(0.0);
        Certificate {
            bias,
            primal: 0.5 * squared_norm + slack,
            dual: sum - 0.5 * squared_norm,
            squared_norm,
            gap,
        }
    }

    /// The biases that the gap of the last certificate, handed in, cannot tell apart.
    pub(crate) fn bias_interval(&self, certificate: &Certificate) -> [f64; 2] {
        self.numbers.slack.within(certificate.gap, certificate.bias)
    }

    /// By how much the optimality conditions are missed: by the values that b must have for the
    /// points that may rise and those that may fall.
    pub(crate) fn largest_violation(&self) -> f64 {
        let mut highest = f64::NEG_INFINITY;
        let mut lowest = f64::INFINITY;
        for (i, point) in self.problem.points.iter().enumerate() {
            let value = point.sign * self.violation(i);
            let [may_rise, may_fall] = point.may_move(self.numbers.alpha[i]);
            highest = if may_rise { highest.max(value) } else { highest };
            lowest = if may_fall { lowest.min(value) } else { lowest };
        }
        (highest - lowest).max(0.0)
    }
}

/// |T g|.
#[inline]
pub(crate) fn scaled_norm(point: &PreparedPoint, gradient: &Vector3) -> f64 {
    if point.is_uncertain() { (point.factor * gradient).norm() } else { 0.0 }
}
