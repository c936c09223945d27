//! One predictor-corrector step.

use nalgebra::Vector4;

use crate::interior::cone::{Scaling, longest_step, product, quotient};
use crate::interior::iterate::{Iterate, head};
use crate::interior::newton::Newton;

/// Share of the way to the boundary that a step goes.
const STEP: f64 = 0.99;

/// Variables from which on a step is corrected anew, with what the last correction has found: that takes a
/// fifth fewer iterations, whose factors are cubic, for solutions, which are quadratic.
const WORTH_CORRECTING: usize = 200;
/// How often at most.
const CORRECTIONS: usize = 2;

/// A step of the iterate.
#[derive(Default)]
struct Direction {
    z: Vec<Vector4<f64>>,
    s: Vec<Vector4<f64>>,
    xi: Vec<f64>,
    bias: f64,
}

impl Iterate<'_> {
    /// One predictor-corrector step; `None` when rounding stops it.
    pub(super) fn step(&mut self, newton: &mut Newton) -> Option<()> {
        let n = self.z.len();
        self.scalings.clear();
        for (z, s) in self.z.iter().zip(&self.s) {
            self.scalings.push(Scaling::of(z, s)?);
        }
        newton.factor(&self.scalings, |i| self.xi[i] / self.u[i])?;
        let pairs = (0..n).map(|i| self.z[i].dot(&self.s[i]) + self.u[i] * self.xi[i]);
        let complementarity = pairs.sum::<f64>() / (2 * n) as f64;
        let predictor = self.direction(newton, |i| -self.square(i), |i| -self.u[i] * self.xi[i])?;
        let target = complementarity * (1.0 - self.longest(&predictor)).powi(3);
        let mut corrected = self.corrected(newton, &predictor, target)?;
        let mut longest = self.longest(&corrected);
        let corrections = if newton.variables() < WORTH_CORRECTING { 0 } else { CORRECTIONS };
        for _ in 0..corrections {
            let Some(again) = self.corrected(newton, &corrected, target) else { break };
            let reach = self.longest(&again);
            if reach <= longest {
                break;
            }
            (corrected, longest) = (again, reach);
        }
        let length = STEP * longest;
        for i in 0..n {
            self.z[i] += corrected.z[i] * length;
            self.s[i] += corrected.s[i] * length;
            self.u[i] -= corrected.z[i][0] * length;
            self.xi[i] += corrected.xi[i] * length;
        }
        self.bias += corrected.bias * length;
        (length > 1e-10).then_some(())
    }

    /// The direction to products of `target`, with the second-order terms that a direction known before has.
    fn corrected(&self, newton: &mut Newton, known: &Direction, target: f64) -> Option<Direction> {
        let cone = |i: usize| {
            let (w, z, s) = (&self.scalings[i], &known.z[i], &known.s[i]);
            head(target) - self.square(i) - product(&w.apply_inverse(s), &w.apply(z))
        };
        let bound = |i: usize| target - self.u[i] * self.xi[i] + known.z[i][0] * known.xi[i];
        self.direction(newton, cone, bound)
    }

    /// λ∘λ of a point.
    fn square(&self, i: usize) -> Vector4<f64> {
        product(&self.scalings[i].lambda, &self.scalings[i].lambda)
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
