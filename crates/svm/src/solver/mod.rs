//! Solving problems, one after another.

mod ladder;
pub(crate) mod settings;
mod work;

use std::ops::ControlFlow;

use cloudtouch_geom::Vector3;

use crate::problem::Problem;
use crate::smo::Tools;
use crate::smo::rows::KernelRows;
use crate::smo::state::{Numbers, State};
use crate::solution::{Effort, Solution};
use crate::solver::settings::{Settings, SettingsError};
use crate::watch::{Progress, Watch};

/// Checked settings, and the memory of the last solve for the next one.
///
/// What was solved before has no influence on an answer. The interior point method and Clarabel, which
/// few problems need, take memory of their own; the former leaves some to the next solve of its thread.
#[derive(Debug)]
pub struct Solver {
    settings: Settings,
    numbers: Numbers,
    rows: KernelRows,
}

impl Solver {
    /// A solver with these settings.
    ///
    /// # Errors
    /// When a setting is out of its range.
    pub fn new(settings: Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings, numbers: Numbers::default(), rows: KernelRows::default() })
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Solves a problem from scratch.
    ///
    /// SMO runs first. When it does not reach the tolerance (and [`Settings::fallback`] allows it)
    /// the dense interior point method takes over, then, with the feature `clarabel`, Clarabel on the
    /// same dual; the answer with the smallest gap is returned. The gap is always recomputed from the
    /// multipliers. Where the tolerance leaves the probabilities of samples open, as at tiny penalties
    /// or kernel widths, the problem is solved tighter than asked.
    ///
    /// Deterministic, and bounded: each of the three may do so much work and no more, whatever the
    /// size of the problem, and none begins what it could not finish. A solve takes milliseconds as
    /// a rule, some seconds at worst, and then says [what kept it](Solution::status).
    pub fn solve(&mut self, problem: &Problem) -> Solution {
        self.run(problem, None, Watch::nobody())
    }

    /// Solves a problem starting from the solution of a similar one with the same samples in the
    /// same order, such as the previous pose; repairs what is not feasible here.
    ///
    /// A solution with another number of samples, or one that is not finite, counts as no start.
    pub fn solve_from(&mut self, problem: &Problem, start: &Solution) -> Solution {
        self.run(problem, Some(start), Watch::nobody())
    }

    /// Solves a problem, from scratch or from a start, and shows `look` how it goes on: SMO after every
    /// half as many steps as there are samples, 8 to 256, the interior point method at each iteration,
    /// Clarabel once it has ended.
    ///
    /// When `look` breaks, the solve ends with what it has, as
    /// [`Status::Cancelled`](crate::Status::Cancelled) unless that is within the tolerance.
    pub fn solve_watched(
        &mut self,
        problem: &Problem,
        start: Option<&Solution>,
        look: &mut dyn FnMut(&Progress) -> ControlFlow<()>,
    ) -> Solution {
        self.run(problem, start, Watch::new(look))
    }

    /// Solves a problem with Clarabel alone: the reference the ladder is tested against.
    ///
    /// Slow: the dual has four variables a point and a dense matrix. Problems of more than 600
    /// uncertain points end as [`Status::TooLarge`](crate::Status::TooLarge).
    #[cfg(feature = "clarabel")]
    pub fn solve_with_clarabel(&mut self, problem: &Problem) -> Solution {
        let span = tracing::debug_span!("robust_svm_clarabel", points = problem.len());
        let _entered = span.enter();
        self.rows.reset(problem);
        let effort = Effort::default();
        let mut tools = Tools { rows: &mut self.rows, watch: Watch::nobody(), effort };
        ladder::clarabel_alone(problem, &self.settings, &mut tools)
    }

    fn run(&mut self, problem: &Problem, start: Option<&Solution>, watch: Watch<'_>) -> Solution {
        let span = tracing::debug_span!("robust_svm_solve", points = problem.len());
        let _entered = span.enter();
        self.rows.reset(problem);
        let numbers = std::mem::take(&mut self.numbers);
        let state = match start.filter(|start| fits(start, problem)) {
            Some(start) => warm(problem, numbers, start, &mut self.rows),
            None => State::cold(problem, numbers),
        };
        let mut tools = Tools { rows: &mut self.rows, watch, effort: Effort::default() };
        let (solution, numbers) = ladder::climb(state, &self.settings, &mut tools);
        self.numbers = numbers;
        solution
    }
}

fn fits(start: &Solution, problem: &Problem) -> bool {
    let finite = start.alpha.iter().chain(start.v.iter().flatten()).all(|value| value.is_finite());
    start.alpha.len() == problem.len() && start.v.len() == problem.len() && finite
}

fn warm<'a>(
    problem: &'a Problem,
    numbers: Numbers,
    start: &Solution,
    rows: &mut KernelRows,
) -> State<'a> {
    let p = problem.points.iter().zip(&start.v).map(|(point, v)| {
        if point.is_uncertain() { point.axes.tr_mul(v) / point.radius } else { Vector3::zeros() }
    });
    State::from_duals(problem, numbers, start.alpha.iter().copied().zip(p), rows)
}

impl Problem {
    /// Solves this one problem; see [`Solver::solve`].
    ///
    /// # Errors
    /// When a setting is out of its range.
    pub fn solve(&self, settings: &Settings) -> Result<Solution, SettingsError> {
        Ok(Solver::new(*settings)?.solve(self))
    }
}
