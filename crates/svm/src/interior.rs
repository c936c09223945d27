//! Rung 2: a dense primal-dual interior point method on the dual (eq. 13).
//!
//! Mehrotra's predictor and corrector with Nesterov–Todd scaling. Writing z_i = (α_i, p_i) in its
//! cone with multiplier s_i, u_i = C_i − α_i ≥ 0 with multiplier ξ_i, and the bias b for Σcα = 0:
//! Q z − e − s + ξ + b c = 0. Every iterate is feasible, so its gap can be certified.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use nalgebra::Vector4;

use crate::cone::{Scaling, longest_step, product, quotient};
use crate::gram::{Variable, gram, variables};
use crate::problem::Problem;
use crate::state::{Numbers, State};
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

/// The iterate: one cone pair and one bound pair for each point.
struct Iterate {
    z: Vec<Vector4<f64>>,
    s: Vec<Vector4<f64>>,
    u: Vec<f64>,
    xi: Vec<f64>,
    bias: f64,
}

struct Direction {
    z: Vec<Vector4<f64>>,
    s: Vec<Vector4<f64>>,
    xi: Vec<f64>,
    bias: f64,
}

/// How far the method came.
pub(crate) struct Reached<'a> {
    /// The best state found; none where not even the first was finite.
    pub(crate) state: Option<State<'a>>,
    pub(crate) iterations: usize,
    pub(crate) status: Status,
}

/// Solves the dual to `relative_gap`, or as far as rounding and `allowed` iterations let it.
///
/// `typical` is a guess at the mean of the multipliers: each iteration changes them by a bounded
/// factor, so that large penalties take many iterations from a small start.
pub(crate) fn solve<'a>(
    problem: &'a Problem,
    relative_gap: f64,
    typical: f64,
    allowed: usize,
    watch: &mut Watch<'_>,
) -> Reached<'a> {
    let variables = variables(problem);
    let Some(quadratic) = gram(problem, &variables) else {
        return Reached { state: None, iterations: 0, status: Status::TooLarge };
    };
    let reaches = problem.points.iter().map(|p| problem.kernel.squared_reach(&p.x));
    let start = (START / reaches.fold(0.0, f64::max)).min(f64::MAX);
    let mut at = Iterate::start(problem, typical.max(start));
    let mut best: Option<(State<'_>, f64)> = None;
    let mut worse = 0;
    let allowed = allowed.min(MAX_ITERATIONS);
    let mut status = Status::IterationLimit;
    let mut iterations = 0;
    while iterations < allowed {
        let mut state = at.state(problem);
        let certificate = state.certificate();
        let gap = certificate.relative_gap();
        let stop = watch.shows_stop(Rung::InteriorPoint, iterations, &state, &certificate);
        if gap.is_finite() && best.as_ref().is_none_or(|(_, least)| gap < *least) {
            best = Some((state, gap));
            worse = 0;
        } else {
            worse += 1;
        }
        let least = best.as_ref().map_or(f64::INFINITY, |(_, least)| *least);
        let end = if least <= relative_gap {
            Some(Status::Converged)
        } else if stop {
            Some(Status::Cancelled)
        } else if worse >= MAX_STALLED && least <= NEAR {
            Some(Status::Stalled)
        } else {
            // A scaling or a factor that fails is rounding too.
            at.step(problem, &variables, &quadratic).is_none().then_some(Status::Stalled)
        };
        if let Some(end) = end {
            status = end;
            break;
        }
        iterations += 1;
    }
    let state = best.map(|(state, _)| state);
    let status =
        if state.is_none() && status == Status::Stalled { Status::NotFinite } else { status };
    Reached { state, iterations, status }
}

impl Iterate {
    /// Multipliers of about `size` and well inside their range with Σcα = 0, cone vectors 0.
    fn start(problem: &Problem, size: f64) -> Self {
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
        let head = |value: f64| Vector4::new(value, 0.0, 0.0, 0.0);
        Self {
            z: alpha.iter().map(|a| head(*a)).collect(),
            s: vec![head(1.0); points.len()],
            u: points.iter().zip(&alpha).map(|(p, a)| p.penalty - a).collect(),
            xi: vec![1.0; points.len()],
            bias: 0.0,
        }
    }

    fn state<'a>(&self, problem: &'a Problem) -> State<'a> {
        let p = self.z.iter().map(|z| z.fixed_rows::<3>(1).into_owned());
        State::from_duals(problem, Numbers::default(), self.z.iter().map(|z| z[0]), p)
    }

    /// One predictor-corrector step; `None` when rounding stops it.
    fn step(
        &mut self,
        problem: &Problem,
        variables: &[Variable],
        quadratic: &Mat<f64>,
    ) -> Option<()> {
        let points = &problem.points;
        let n = points.len();
        let scalings: Vec<Scaling> =
            self.z.iter().zip(&self.s).map(|(z, s)| Scaling::of(z, s)).collect::<Option<_>>()?;
        let mut matrix = quadratic.clone();
        add_scalings(&mut matrix, variables, &scalings, |i| self.xi[i] / self.u[i]);
        let factor = matrix.llt(Side::Lower).ok()?;
        let residual = self.stationarity(problem, variables, quadratic);
        let labels = gathered(variables, &points.iter().map(|p| head(p.sign)).collect::<Vec<_>>());
        let toward_bias = factor.solve(&labels);
        let border = dot(&labels, &toward_bias);

        // `cone` is λ∘(W dz + W⁻¹ ds), `bound` is u dξ + ξ du.
        let direction = |cone: &[Vector4<f64>], bound: &[f64]| -> Option<Direction> {
            let pushed: Vec<Vector4<f64>> = (0..n)
                .map(|i| scalings[i].apply(&quotient(&scalings[i].lambda, &cone[i])))
                .collect();
            let right: Vec<Vector4<f64>> =
                (0..n).map(|i| pushed[i] - residual[i] - head(bound[i] / self.u[i])).collect();
            let free = factor.solve(&gathered(variables, &right));
            let bias = dot(&labels, &free) / border;
            let solution = &free - &toward_bias * faer::Scale(bias);
            let z = scattered(variables, &solution, n);
            let s = (0..n).map(|i| pushed[i] - scalings[i].squared() * z[i]).collect();
            let xi = (0..n).map(|i| (bound[i] + self.xi[i] * z[i][0]) / self.u[i]).collect();
            let finite = bias.is_finite() && z.iter().all(|z| z.iter().all(|v| v.is_finite()));
            finite.then_some(Direction { z, s, xi, bias })
        };

        let complementarity =
            (0..n).map(|i| self.z[i].dot(&self.s[i]) + self.u[i] * self.xi[i]).sum::<f64>()
                / (2 * n) as f64;
        let squares: Vec<Vector4<f64>> =
            scalings.iter().map(|w| product(&w.lambda, &w.lambda)).collect();
        let predictor = direction(
            &squares.iter().map(|x| -x).collect::<Vec<_>>(),
            &(0..n).map(|i| -self.u[i] * self.xi[i]).collect::<Vec<_>>(),
        )?;
        let target = complementarity * (1.0 - self.longest(&predictor)).powi(3);
        let cone: Vec<Vector4<f64>> = (0..n)
            .map(|i| {
                let (w, z, s) = (&scalings[i], &predictor.z[i], &predictor.s[i]);
                head(target) - squares[i] - product(&w.apply_inverse(s), &w.apply(z))
            })
            .collect();
        let bound: Vec<f64> = (0..n)
            .map(|i| target - self.u[i] * self.xi[i] + predictor.z[i][0] * predictor.xi[i])
            .collect();
        let corrected = direction(&cone, &bound)?;
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

    /// Q z − e − s + ξ + b c, point by point.
    fn stationarity(
        &self,
        problem: &Problem,
        variables: &[Variable],
        quadratic: &Mat<f64>,
    ) -> Vec<Vector4<f64>> {
        let moved = quadratic * gathered(variables, &self.z);
        let mut residual = scattered(variables, &moved, self.z.len());
        for (i, point) in problem.points.iter().enumerate() {
            residual[i] -= self.s[i];
            residual[i][0] += self.xi[i] - 1.0 + self.bias * point.sign;
        }
        residual
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

/// Adds each point's H, and its bound's ξ/u, to the diagonal blocks.
fn add_scalings(
    matrix: &mut Mat<f64>,
    variables: &[Variable],
    scalings: &[Scaling],
    bound: impl Fn(usize) -> f64,
) {
    let mut begin = 0;
    while begin < variables.len() {
        let point = variables[begin].point;
        let size = variables[begin..].iter().take_while(|v| v.point == point).count();
        let h = scalings[point].squared();
        for row in 0..size {
            for column in 0..size {
                let (r, c) = (variables[begin + row].slot(), variables[begin + column].slot());
                matrix[(begin + row, begin + column)] += h[(r, c)];
            }
        }
        matrix[(begin, begin)] += bound(point);
        begin += size;
    }
}

fn gathered(variables: &[Variable], blocks: &[Vector4<f64>]) -> Mat<f64> {
    Mat::from_fn(variables.len(), 1, |k, _| blocks[variables[k].point][variables[k].slot()])
}

fn scattered(variables: &[Variable], column: &Mat<f64>, points: usize) -> Vec<Vector4<f64>> {
    let mut blocks = vec![Vector4::zeros(); points];
    for (k, variable) in variables.iter().enumerate() {
        blocks[variable.point][variable.slot()] = column[(k, 0)];
    }
    blocks
}

fn dot(a: &Mat<f64>, b: &Mat<f64>) -> f64 {
    (0..a.nrows()).map(|k| a[(k, 0)] * b[(k, 0)]).sum()
}
