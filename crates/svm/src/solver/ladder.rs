//! The ladder: SMO first, then the dense interior point method, then Clarabel.

use crate::bounds::{bias_spread, error_bounds, is_collapsed};
use crate::certificate::Certificate;
#[cfg(feature = "clarabel")]
use crate::clarabel_dual;
use crate::interior::active::interior_point;
use crate::problem::Problem;
use crate::smo::state::{Numbers, State};
use crate::smo::{Limits, Tools, improve};
use crate::solution::{Effort, LARGEST_GAP, Solution, Undetermined};
use crate::solver::settings::Settings;
use crate::solver::work;
use crate::status::{Ends, Rung, Status};

/// How much tighter a problem is solved that determines no probability yet.
const TIGHTER: f64 = 1e-2;
/// No tolerance is tightened beyond this: rounding is next.
const TIGHTEST: f64 = 1e-14;
/// Samples up to which the interior point method takes so little time that SMO's counts beside it.
const SOON_DONE: usize = 200;
/// Twenty are usual.
#[cfg(feature = "clarabel")]
const CLARABEL_ITERATIONS: usize = 200;

/// How far the ladder has come.
pub(crate) struct Reached<'a> {
    pub(crate) state: State<'a>,
    pub(crate) certificate: Certificate,
    pub(crate) rung: Rung,
    pub(crate) ends: Ends,
}

/// Climbs from a start. Where the tolerance leaves the probabilities of samples open, as at tiny
/// penalties or kernel widths, the problem is solved tighter than asked.
pub(crate) fn climb(
    start: State<'_>,
    settings: &Settings,
    tools: &mut Tools<'_, '_>,
) -> (Solution, Numbers) {
    let problem = start.problem;
    let mut tolerance = settings.relative_gap;
    let rungs = [Rung::InteriorPoint, Rung::Clarabel];
    let mut reached = climb_to(tolerance, start, &rungs, settings, tools);
    let mut solution = conclude(&reached, settings, tools);
    while settings.max_steps.is_none()
        && !tools.watch.is_cancelled()
        && tolerance > TIGHTEST
        && tools.effort.smo_steps < work::step_budget(problem.len())
        && is_open(&solution, tolerance)
    {
        // What is left of the steps, and our own interior point method, but not Clarabel.
        tolerance = (TIGHTER * solution.relative_gap).max(TIGHTEST);
        let start = reached.state.copied(tools.rows);
        let next = climb_to(tolerance, start, &rungs[..1], settings, tools);
        if next.certificate.relative_gap() >= solution.relative_gap {
            break;
        }
        let polished = next.rung == Rung::Smo;
        let rung = if polished { reached.rung } else { next.rung };
        reached = Reached { rung, ends: next.ends.or(reached.ends), ..next };
        solution = conclude(&reached, settings, tools);
    }
    (solution, reached.state.numbers)
}

/// Whether a gap that is small beside the objective is not small beside w, or not beside what the
/// bias is determined by.
fn is_open(solution: &Solution, tolerance: f64) -> bool {
    let open = solution.determined();
    solution.relative_gap <= tolerance
        && matches!(open, Err(Undetermined::Weight { .. } | Undetermined::Bias { .. }))
}

/// The ladder once, over the `fallbacks` in their order.
fn climb_to<'a>(
    tolerance: f64,
    mut state: State<'a>,
    fallbacks: &[Rung],
    settings: &Settings,
    tools: &mut Tools<'_, '_>,
) -> Reached<'a> {
    let n = state.problem.len();
    let automatic = work::step_budget(n).saturating_sub(tools.effort.smo_steps);
    let limits = Limits {
        relative_gap: tolerance,
        max_steps: settings.max_steps.unwrap_or(automatic),
        predict: settings.max_steps.is_none(),
        gives_way: settings.fallback && n <= SOON_DONE,
    };
    let mut ends = Ends::default();
    let (mut certificate, end) = improve(&mut state, &limits, tools);
    ends.note(Rung::Smo, end);
    let mut rung = Rung::Smo;
    for &fallback in fallbacks {
        if certificate.relative_gap() <= tolerance
            || !settings.fallback
            || tools.watch.is_cancelled()
        {
            break;
        }
        let (other, end) = fall_back(fallback, &mut state, tolerance, tools);
        ends.note(fallback, end);
        let Some(mut other) = other else { continue };
        let mut second = other.certificate();
        if second.relative_gap() > tolerance && !tools.watch.is_cancelled() {
            // Interior points stop short of the last digits, which are SMO's to find.
            let polish = Limits { max_steps: 10 * n, predict: false, ..limits };
            second = improve(&mut other, &polish, tools).0;
        }
        if second.relative_gap() <= tolerance {
            ends.note(fallback, Status::Converged);
        } else if end == Status::Converged {
            // By its own numbers, of which large penalties leave fewer digits than it took them to have.
            ends.note(fallback, Status::Stalled);
        }
        if second.relative_gap() < certificate.relative_gap() {
            (state, certificate, rung) = (other, second, fallback);
        }
    }
    Reached { state, certificate, rung, ends }
}

/// What another rung finds, and how it ended.
fn fall_back<'a>(
    rung: Rung,
    so_far: &mut State<'a>,
    relative_gap: f64,
    tools: &mut Tools<'_, '_>,
) -> (Option<State<'a>>, Status) {
    let problem = so_far.problem;
    if rung == Rung::Clarabel {
        return match work::clarabel_iterations(problem) {
            Some(allowed) => ask_clarabel(problem, allowed, relative_gap, tools),
            None => (None, Status::TooLarge),
        };
    }
    let Some(allowed) = work::interior_iterations(problem) else {
        return (None, Status::TooLarge);
    };
    interior_point(so_far, relative_gap, allowed, tools)
}

#[cfg(not(feature = "clarabel"))]
fn ask_clarabel<'a>(
    _: &'a Problem,
    _: usize,
    _: f64,
    _: &mut Tools<'_, '_>,
) -> (Option<State<'a>>, Status) {
    (None, Status::NotBuilt)
}

#[cfg(feature = "clarabel")]
fn ask_clarabel<'a>(
    problem: &'a Problem,
    allowed: usize,
    relative_gap: f64,
    tools: &mut Tools<'_, '_>,
) -> (Option<State<'a>>, Status) {
    let allowed = allowed.min(CLARABEL_ITERATIONS);
    let dual = match clarabel_dual::solve(problem, relative_gap, allowed) {
        Ok(dual) => dual,
        Err(status) => return (None, status),
    };
    tools.effort.clarabel_iterations += dual.iterations;
    let mut state = State::from_duals(
        problem,
        Numbers::default(),
        dual.alpha.into_iter().zip(dual.p),
        tools.rows,
    );
    let certificate = state.certificate();
    tools
        .watch
        .shows_stop(Rung::Clarabel, dual.iterations, &certificate, || state.largest_violation());
    // Its own tolerance is not that of the gap.
    let reached = certificate.relative_gap() <= relative_gap;
    let end = match (reached, dual.status) {
        (true, _) => Status::Converged,
        (false, Status::Converged) => Status::Stalled,
        (false, end) => end,
    };
    (Some(state), end)
}

/// Solves with Clarabel alone, whatever the size of the problem as long as its matrix is built.
#[cfg(feature = "clarabel")]
pub(crate) fn clarabel_alone(
    problem: &Problem,
    settings: &Settings,
    tools: &mut Tools<'_, '_>,
) -> Solution {
    let (state, end) = ask_clarabel(problem, CLARABEL_ITERATIONS, settings.relative_gap, tools);
    let mut state = state.unwrap_or_else(|| State::cold(problem, Numbers::default()));
    let ends = Ends { clarabel: Some(end), ..Ends::default() };
    let certificate = state.certificate();
    conclude(&Reached { state, certificate, rung: Rung::Clarabel, ends }, settings, tools)
}

fn conclude(reached: &Reached<'_>, settings: &Settings, tools: &Tools<'_, '_>) -> Solution {
    let Reached { state, certificate, rung, ends } = reached;
    let problem = state.problem;
    let relative_gap = certificate.relative_gap();
    let tolerance = settings.relative_gap;
    let status = if !certificate.is_finite() {
        Status::NotFinite
    } else if relative_gap <= tolerance.max(LARGEST_GAP) && is_collapsed(state, certificate) {
        Status::Collapsed
    } else if relative_gap <= tolerance {
        Status::Converged
    } else if tools.watch.is_cancelled() {
        Status::Cancelled
    } else {
        ends.why_not()
    };
    let effort = Effort { kernel_rows: tools.rows.computed(), ..tools.effort };
    tracing::debug!(?status, ?rung, relative_gap, ?effort, "solved");
    let bias_interval = state.bias_interval(certificate);
    let samples = || problem.points.iter().enumerate();
    Solution {
        alpha: samples().map(|(i, _)| state.numbers.alpha.at(i)).collect(),
        v: samples().map(|(i, point)| point.axes * state.numbers.p(i) * point.radius).collect(),
        displacement: samples().map(|(i, point)| point.displacement(&state.numbers.p(i))).collect(),
        bias: certificate.bias,
        bias_interval,
        bias_spread: bias_spread(state, bias_interval),
        primal: certificate.primal,
        dual: certificate.dual,
        squared_norm: certificate.squared_norm,
        relative_gap,
        error: error_bounds(state, certificate),
        status,
        ends: *ends,
        rung: *rung,
        effort,
    }
}
