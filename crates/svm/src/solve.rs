//! The ladder: SMO first, then the dense interior point method, then Clarabel.

use cloudtouch_geom::Vector3;

use crate::clarabel_dual;
use crate::interior;
use crate::problem::Problem;
use crate::settings::Settings;
use crate::smo::{Limits, improve};
use crate::solution::{Effort, Rung, Solution, Status};
use crate::state::{Certificate, State};
use crate::work;

/// Twenty are usual.
const CLARABEL_ITERATIONS: usize = 200;

impl Problem {
    /// Solves the problem from scratch.
    ///
    /// SMO runs first. When it does not reach the tolerance (and [`Settings::fallback`] allows it)
    /// the dense interior point method takes over, then Clarabel on the same dual; the answer with
    /// the smallest gap is returned. The gap is always recomputed from the multipliers.
    /// Deterministic, and bounded: each of the three may do so much work and no more, whatever the
    /// size of the problem, and none begins what it could not finish. A solve takes milliseconds as
    /// a rule, some seconds at worst, and then ends as [`Status::StepLimit`].
    pub fn solve(&self, settings: &Settings) -> Solution {
        self.climb(State::cold(self), settings)
    }

    /// Solves the problem starting from the solution of a similar one with the same samples in the
    /// same order, such as the previous pose; repairs what is not feasible here.
    ///
    /// A solution with another number of samples, or one that is not finite, counts as no start.
    pub fn solve_from(&self, settings: &Settings, warm: &Solution) -> Solution {
        if warm.alpha.len() != self.len() || warm.v.len() != self.len() {
            return self.solve(settings);
        }
        let p: Vec<Vector3> = self
            .points
            .iter()
            .zip(&warm.v)
            .map(|(point, v)| {
                if point.is_uncertain() {
                    point.axes.tr_mul(v) / point.radius
                } else {
                    Vector3::zeros()
                }
            })
            .collect();
        self.climb(State::from_duals(self, &warm.alpha, &p), settings)
    }

    /// Solves the problem with Clarabel alone: the reference the ladder is tested against.
    ///
    /// Slow: the dual has four variables a point and a dense matrix. Problems of more than 600
    /// uncertain points end as [`Status::TooLarge`].
    pub fn solve_with_clarabel(&self, settings: &Settings) -> Solution {
        let span = tracing::debug_span!("robust_svm_clarabel", points = self.len());
        let _entered = span.enter();
        let mut effort = Effort::default();
        match self.ask_clarabel(CLARABEL_ITERATIONS, settings, &mut effort) {
            Some(state) => {
                let certificate = state.certificate();
                self.conclude(&state, &certificate, settings, Rung::Clarabel, effort)
            }
            None => {
                let state = State::cold(self);
                let certificate = state.certificate();
                let solution =
                    self.conclude(&state, &certificate, settings, Rung::Clarabel, effort);
                Solution { status: Status::TooLarge, ..solution }
            }
        }
    }

    fn climb<'a>(&'a self, mut state: State<'a>, settings: &Settings) -> Solution {
        let span = tracing::debug_span!("robust_svm_solve", points = self.len());
        let _entered = span.enter();
        let n = self.len();
        let tolerance = settings.relative_gap();
        let mut effort = Effort::default();
        let limits = Limits {
            relative_gap: tolerance,
            max_steps: settings.step_budget().unwrap_or_else(|| work::step_budget(n)),
            predict: settings.step_budget().is_none(),
        };
        let mut certificate = improve(&mut state, &limits, &mut effort);
        let mut rung = Rung::Smo;
        for fallback in [Rung::InteriorPoint, Rung::Clarabel] {
            if certificate.relative_gap() <= tolerance || !settings.allows_fallback() {
                break;
            }
            let Some(mut other) = self.fall_back(fallback, &state, settings, &mut effort) else {
                continue;
            };
            let mut second = other.certificate();
            if second.relative_gap() > tolerance {
                // Interior points stop short of the last digits, which are SMO's to find.
                let polish = Limits { max_steps: 10 * n, predict: false, ..limits };
                second = improve(&mut other, &polish, &mut effort);
            }
            if second.relative_gap() < certificate.relative_gap() {
                (state, certificate, rung) = (other, second, fallback);
            }
        }
        self.conclude(&state, &certificate, settings, rung, effort)
    }

    /// What another rung finds; `None` when the problem is too large for it.
    fn fall_back(
        &self,
        rung: Rung,
        so_far: &State<'_>,
        settings: &Settings,
        effort: &mut Effort,
    ) -> Option<State<'_>> {
        if rung == Rung::Clarabel {
            let allowed = work::clarabel_iterations(self)?.min(CLARABEL_ITERATIONS);
            return self.ask_clarabel(allowed, settings, effort);
        }
        // Where SMO got stuck its multipliers are of the right size, if nothing more.
        let typical = so_far.alpha.iter().sum::<f64>() / self.len() as f64;
        let allowed = work::interior_iterations(self)?;
        let (state, iterations) = interior::solve(self, settings.relative_gap(), typical, allowed)?;
        effort.interior_iterations += iterations;
        Some(state)
    }

    fn ask_clarabel(
        &self,
        max_iterations: usize,
        settings: &Settings,
        effort: &mut Effort,
    ) -> Option<State<'_>> {
        let dual = clarabel_dual::solve(self, settings.relative_gap(), max_iterations)?;
        effort.clarabel_iterations += dual.iterations;
        Some(State::from_duals(self, &dual.alpha, &dual.p))
    }

    fn conclude(
        &self,
        state: &State<'_>,
        certificate: &Certificate,
        settings: &Settings,
        rung: Rung,
        effort: Effort,
    ) -> Solution {
        let relative_gap = certificate.relative_gap();
        let status = if !certificate.is_finite() {
            Status::NotFinite
        } else if relative_gap > settings.relative_gap() {
            Status::StepLimit
        } else if certificate.squared_norm <= 2.0 * certificate.gap + norm_rounding(state) {
            Status::Collapsed
        } else {
            Status::Converged
        };
        let v = self
            .points
            .iter()
            .zip(&state.p)
            .map(|(point, p)| point.axes * p * point.radius)
            .collect();
        tracing::debug!(
            ?status,
            ?rung,
            relative_gap,
            smo_steps = effort.smo_steps,
            ball_steps = effort.ball_steps,
            kernel_rows = effort.kernel_rows,
            interior_iterations = effort.interior_iterations,
            clarabel_iterations = effort.clarabel_iterations,
            "solved"
        );
        Solution {
            alpha: state.alpha.clone(),
            v,
            bias: certificate.bias,
            primal: certificate.primal,
            dual: certificate.dual,
            squared_norm: certificate.squared_norm,
            relative_gap,
            status,
            rung,
            effort,
        }
    }
}

/// What rounding alone can leave of |w|² when w = 0: the terms of βᵀBβ cancel.
fn norm_rounding(state: &State<'_>) -> f64 {
    let points = &state.problem.points;
    let kernel = state.problem.kernel;
    let lengths = points.iter().zip(state.alpha.iter().zip(&state.p)).map(|(point, (alpha, p))| {
        let own = kernel.value(&point.x, &point.x).sqrt();
        alpha * own + point.displacement(p).norm() * kernel.self_curvature().sqrt()
    });
    f64::EPSILON * lengths.sum::<f64>().powi(2)
}
