//! A dual point with the decision function it induces at the samples, and its duality gap.

use cloudtouch_geom::{Vector3, normal};

use crate::problem::{PreparedPoint, Problem};

/// Dual variables and, kept in step with them, f₀ and its gradient at every sample.
#[derive(Clone)]
pub(crate) struct State<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) alpha: Vec<f64>,
    /// Dual vectors in the eigenbasis of each covariance, |p| ≤ α.
    pub(crate) p: Vec<Vector3>,
    /// f₀ = f − b at the samples.
    pub(crate) f: Vec<f64>,
    /// ∇f₀ at the samples, world axes.
    pub(crate) gradient: Vec<Vector3>,
    /// |T∇f₀| at the samples.
    pub(crate) norm: Vec<f64>,
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

/// From one margin of a classifier, f = 1, to the other f has a range of 2. Where the samples take
/// it well beyond that the bound on its error says nothing: slack dominates the gap.
const AMPLE_RANGE: f64 = 5.0;
/// Errors of f are at most this share of their bound, in thousands of problems of any penalty and
/// kernel width.
const SHARE_SEEN: f64 = 0.35;

impl<'a> State<'a> {
    /// The dual point 0.
    pub(crate) fn cold(problem: &'a Problem) -> Self {
        let n = problem.len();
        Self {
            problem,
            alpha: vec![0.0; n],
            p: vec![Vector3::zeros(); n],
            f: vec![0.0; n],
            gradient: vec![Vector3::zeros(); n],
            norm: vec![0.0; n],
        }
    }

    /// The nearest feasible point found by clipping to the box and the cones, then shrinking the
    /// heavier class until Σcα = 0. Values that are not finite become 0.
    pub(crate) fn from_duals(problem: &'a Problem, alpha: &[f64], p: &[Vector3]) -> Self {
        let mut state = Self::cold(problem);
        let mut totals = [0.0; 2];
        for (i, point) in problem.points.iter().enumerate() {
            let value = if alpha[i].is_finite() { alpha[i].clamp(0.0, point.penalty) } else { 0.0 };
            state.alpha[i] = value;
            totals[usize::from(point.sign < 0.0)] += value;
            let usable = point.is_uncertain() && p[i].iter().all(|v| v.is_finite());
            if usable {
                state.p[i] = p[i].zip_map(&point.t, |p, t| if t > 0.0 { p } else { 0.0 });
            }
        }
        let lighter = totals[0].min(totals[1]);
        let shrink = totals.map(|total| if total > lighter { lighter / total } else { 1.0 });
        for (i, point) in problem.points.iter().enumerate() {
            let factor = shrink[usize::from(point.sign < 0.0)];
            state.alpha[i] *= factor;
            state.p[i] = clip_to_ball(&(state.p[i] * factor), state.alpha[i]);
        }
        state.recompute();
        state
    }

    /// Computes f₀ and its gradient from the dual variables alone.
    pub(crate) fn recompute(&mut self) {
        let kernel = self.problem.kernel;
        let points = &self.problem.points;
        self.f.fill(0.0);
        self.gradient.fill(Vector3::zeros());
        for (source, (&alpha, p)) in points.iter().zip(self.alpha.iter().zip(&self.p)) {
            if alpha == 0.0 {
                continue;
            }
            let (a, s) = (source.sign * alpha, source.displacement(p));
            for (k, target) in points.iter().enumerate() {
                let value = kernel.value(&source.x, &target.x);
                let (df, dg) = kernel.influence(&source.x, &target.x, value, a, &s);
                self.f[k] += df;
                self.gradient[k] += dg;
            }
        }
        for (k, point) in points.iter().enumerate() {
            self.norm[k] = scaled_norm(point, &self.gradient[k]);
        }
    }

    /// y = 1 − c f₀ + |T∇f₀|: how far the worst point of the ellipsoid is inside the margin, b aside.
    #[inline]
    pub(crate) fn violation(&self, i: usize) -> f64 {
        1.0 - self.problem.points[i].sign * self.f[i] + self.norm[i]
    }

    /// α|g| + p·g ≥ 0: what turning p against the gradient could gain at most.
    #[inline]
    pub(crate) fn misalignment(&self, i: usize) -> f64 {
        let point = &self.problem.points[i];
        (self.alpha[i] * self.norm[i] + point.displacement(&self.p[i]).dot(&self.gradient[i]))
            .max(0.0)
    }

    /// Objective values and gap, from the f₀ and gradients at hand.
    ///
    /// gap = Σ (C−α)(y−cb)₊ + α(y−cb)₋ + (α|g| + p·g), with b the minimiser of Σ C(y−cb)₊.
    pub(crate) fn certificate(&self) -> Certificate {
        let points = &self.problem.points;
        let bias = self.best_bias();
        let mut sum = 0.0;
        let mut squared_norm = 0.0;
        let mut slack = 0.0;
        let mut gap = 0.0;
        for (i, point) in points.iter().enumerate() {
            let alpha = self.alpha[i];
            let excess = self.violation(i) - point.sign * bias;
            let above = excess.max(0.0);
            let turned = point.displacement(&self.p[i]).dot(&self.gradient[i]);
            sum += alpha;
            squared_norm += point.sign * alpha * self.f[i] + turned;
            slack += point.penalty * above;
            gap += (point.penalty - alpha) * above + alpha * (above - excess);
            gap += (alpha * self.norm[i] + turned).max(0.0);
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

    /// How far the probability (eq. 16) of an uncertain sample may be off, at most over all of them,
    /// by what the gap leaves open.
    ///
    /// |w − w*| ≤ √(2·gap) bounds the error of f, and with the slope of the feature map that of the
    /// deviation |S ∇f|. Where f hardly reaches its margins, as at small penalties or kernel widths,
    /// that is as large as f itself; where it reaches far beyond, this is 0.
    pub(crate) fn probability_error(&self, certificate: &Certificate) -> f64 {
        let range = self
            .f
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], f| [low.min(*f), high.max(*f)]);
        if range[1] - range[0] >= AMPLE_RANGE {
            return 0.0;
        }
        let kernel = self.problem.kernel;
        let off = SHARE_SEEN * (2.0 * certificate.gap).sqrt();
        let uncertain = self.problem.points.iter().enumerate().filter(|(_, p)| p.is_uncertain());
        let errors = uncertain.map(|(i, point)| {
            let value = point.sign * (self.f[i] + certificate.bias);
            let std = self.norm[i] / point.radius;
            let value_off = off * kernel.value(&point.x, &point.x).sqrt();
            let std_off = off * kernel.self_curvature().sqrt() * point.t[0] / point.radius;
            let probability = normal::below_zero(value, std);
            // The farthest from one half, and the nearest to it or across.
            let extreme = |value: f64, outwards: bool| {
                let wider = (value < 0.0) == outwards;
                let std = if wider { (std - std_off).max(0.0) } else { std + std_off };
                normal::below_zero(value, std)
            };
            let most = extreme(value - value_off, true) - probability;
            let least = probability - extreme(value + value_off, false);
            most.max(least)
        });
        errors.fold(0.0, |worst: f64, error| if error > worst { error } else { worst })
    }

    /// The minimiser of Σ C(y−cb)₊ over b; the middle where the minimum is flat.
    fn best_bias(&self) -> f64 {
        let points = &self.problem.points;
        let mut breaks: Vec<(f64, f64)> = points
            .iter()
            .enumerate()
            .map(|(i, point)| (point.sign * self.violation(i), point.penalty))
            .collect();
        breaks.sort_unstable_by(|l, r| l.0.total_cmp(&r.0));
        // The slope starts at −Σ C over class A and gains C at every break.
        let start: f64 = points.iter().filter(|p| p.sign > 0.0).map(|p| p.penalty).sum();
        let mut slope = -start;
        for (rank, &(at, penalty)) in breaks.iter().enumerate() {
            slope += penalty;
            if slope.abs() <= 1e-12 * start {
                return breaks.get(rank + 1).map_or(at, |next| 0.5 * (at + next.0));
            }
            if slope > 0.0 {
                return at;
            }
        }
        breaks.last().map_or(0.0, |last| last.0)
    }
}

/// |T g|.
#[inline]
pub(crate) fn scaled_norm(point: &PreparedPoint, gradient: &Vector3) -> f64 {
    if point.is_uncertain() { (point.factor * gradient).norm() } else { 0.0 }
}

/// `p`, shortened to `radius` when it is longer.
pub(crate) fn clip_to_ball(p: &Vector3, radius: f64) -> Vector3 {
    let norm = p.norm();
    if norm > radius { p * (radius / norm) } else { *p }
}
