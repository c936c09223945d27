//! The ladder: SMO first, then the dense interior point method, then Clarabel.

use cloudtouch_geom::Vector3;

use crate::clarabel_dual;
use crate::interior;
use crate::problem::Problem;
use crate::settings::Settings;
use crate::smo::{Limits, improve};
use crate::solution::{Effort, LARGEST_ERROR, Rung, Solution, Status};
use crate::state::{Certificate, State};
use crate::work;

/// Twenty are usual.
const CLARABEL_ITERATIONS: usize = 200;
/// How much tighter a problem is solved that determines no probability yet.
const TIGHTER: f64 = 1e-2;
/// No tolerance is tightened beyond this: rounding is next.
const TIGHTEST: f64 = 1e-14;

/// How far the ladder has come.
struct Reached<'a> {
    state: State<'a>,
    certificate: Certificate,
    rung: Rung,
}

impl Reached<'_> {
    /// Whether a gap that is small beside the objective is not small beside w.
    fn leaves_probabilities_open(&self, tolerance: f64) -> bool {
        self.certificate.relative_gap() <= tolerance
            && !is_collapsed(&self.state, &self.certificate)
            && self.state.probability_error(&self.certificate) > LARGEST_ERROR
    }
}

impl Problem {
    /// Solves the problem from scratch.
    ///
    /// SMO runs first. When it does not reach the tolerance (and [`Settings::fallback`] allows it)
    /// the dense interior point method takes over, then Clarabel on the same dual; the answer with
    /// the smallest gap is returned. The gap is always recomputed from the multipliers.
    /// Where the tolerance leaves the probabilities of samples open, as at tiny penalties or kernel
    /// widths, the problem is solved tighter than asked.
    ///
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
        match self.ask_clarabel(CLARABEL_ITERATIONS, settings.relative_gap(), &mut effort) {
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

    fn climb<'a>(&'a self, state: State<'a>, settings: &Settings) -> Solution {
        let span = tracing::debug_span!("robust_svm_solve", points = self.len());
        let _entered = span.enter();
        let mut effort = Effort::default();
        let mut tolerance = settings.relative_gap();
        let rungs = [Rung::InteriorPoint, Rung::Clarabel];
        let mut reached = self.climb_to(tolerance, state, &rungs, settings, &mut effort);
        while settings.step_budget().is_none()
            && tolerance > TIGHTEST
            && effort.smo_steps < work::step_budget(self.len())
            && reached.leaves_probabilities_open(tolerance)
        {
            // What is left of the steps, and our own interior point method, but not Clarabel.
            tolerance = (TIGHTER * reached.certificate.relative_gap()).max(TIGHTEST);
            let start = reached.state.clone();
            let next = self.climb_to(tolerance, start, &rungs[..1], settings, &mut effort);
            if next.certificate.relative_gap() >= reached.certificate.relative_gap() {
                break;
            }
            let polished = next.rung == Rung::Smo;
            reached = Reached { rung: if polished { reached.rung } else { next.rung }, ..next };
        }
        self.conclude(&reached.state, &reached.certificate, settings, reached.rung, effort)
    }

    /// The ladder once, over the `fallbacks` in their order.
    fn climb_to<'a>(
        &'a self,
        tolerance: f64,
        mut state: State<'a>,
        fallbacks: &[Rung],
        settings: &Settings,
        effort: &mut Effort,
    ) -> Reached<'a> {
        let n = self.len();
        let automatic = work::step_budget(n).saturating_sub(effort.smo_steps);
        let limits = Limits {
            relative_gap: tolerance,
            max_steps: settings.step_budget().unwrap_or(automatic),
            predict: settings.step_budget().is_none(),
        };
        let mut certificate = improve(&mut state, &limits, effort);
        let mut rung = Rung::Smo;
        for &fallback in fallbacks {
            if certificate.relative_gap() <= tolerance || !settings.allows_fallback() {
                break;
            }
            let Some(mut other) = self.fall_back(fallback, &state, tolerance, effort) else {
                continue;
            };
            let mut second = other.certificate();
            if second.relative_gap() > tolerance {
                // Interior points stop short of the last digits, which are SMO's to find.
                let polish = Limits { max_steps: 10 * n, predict: false, ..limits };
                second = improve(&mut other, &polish, effort);
            }
            if second.relative_gap() < certificate.relative_gap() {
                (state, certificate, rung) = (other, second, fallback);
            }
        }
        Reached { state, certificate, rung }
    }

    /// What another rung finds; `None` when the problem is too large for it.
    fn fall_back(
        &self,
        rung: Rung,
        so_far: &State<'_>,
        relative_gap: f64,
        effort: &mut Effort,
    ) -> Option<State<'_>> {
        if rung == Rung::Clarabel {
            let allowed = work::clarabel_iterations(self)?.min(CLARABEL_ITERATIONS);
            return self.ask_clarabel(allowed, relative_gap, effort);
        }
        // Where SMO got stuck its multipliers are of the right size, if nothing more.
        let typical = so_far.alpha.iter().sum::<f64>() / self.len() as f64;
        let allowed = work::interior_iterations(self)?;
        let (state, iterations) = interior::solve(self, relative_gap, typical, allowed)?;
        effort.interior_iterations += iterations;
        Some(state)
    }

    fn ask_clarabel(
        &self,
        max_iterations: usize,
        relative_gap: f64,
        effort: &mut Effort,
    ) -> Option<State<'_>> {
        let dual = clarabel_dual::solve(self, relative_gap, max_iterations)?;
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
        } else if is_collapsed(state, certificate) {
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
            probability_error: state.probability_error(certificate),
            status,
            rung,
            effort,
        }
    }
}

/// Whether w = 0 cannot be excluded.
fn is_collapsed(state: &State<'_>, certificate: &Certificate) -> bool {
    certificate.squared_norm <= 2.0 * certificate.gap + norm_rounding(state)
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
