//! The catalogue through the solver, beside Clarabel.

use std::time::Instant;

use anyhow::{Context, Result};
use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint};
use cloudtouch_svm::{Class, Sample, Settings, Solver, UnitBox, balanced_penalties};
use cloudtouch_testkit::hard_cases::{HardCase, HardProblem, hard_cases, hard_problems};

use super::{
    RELATIVE_GAP,
    leaf::{GAMMA, PENALTY, Solved, largest_difference, probabilities},
    sheet::{Sheet, milliseconds, small},
};
use crate::common::table::Table;

/// Points of a side at most: what a leaf holds, and Clarabel can answer.
const MOST: usize = 40;

/// What the section says before its table.
const INTRODUCTION: &str = "Clouds thinned to 40 points a side, in the unit box, with the settings \
of a default query; then settings of the solver out of the ordinary on harmless clouds. *Gap* is the \
relative gap between primal and dual, recomputed from the multipliers; 1e-4 is asked for. *Solver* \
says who answered: SMO, the dense interior point method, or Clarabel as the fallback. *w off* bounds \
the error of the classifier that this gap leaves, as a part of its own size, √(2·gap)/|w|: where it \
is not small, neither are errors of probabilities. The next two columns compare with Clarabel alone: \
relative difference of the primal values, largest difference of a point's probability. `none` there \
means that Clarabel did not reach the tolerance, or that nothing is determined. `Collapsed` is an \
answer: no surface separates the pair.";

/// One problem with its name.
struct Posed {
    name: &'static str,
    samples: Vec<Sample>,
    gamma: f64,
}

/// Solves everything and adds the section.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let header = [
        "case",
        "status",
        "solver",
        "steps",
        "gap",
        "w off",
        "primal, difference",
        "P, difference",
        "ms",
    ];
    let mut table = Table::new(&header);
    let mut tally = Tally::default();
    let clouds = hard_cases();
    let posed = clouds.iter().filter_map(of_clouds);
    for posed in posed.chain(hard_problems().iter().map(of_problem)) {
        let row = sheet.guard(&format!("solver, {}", posed.name), || solve(&posed));
        let Some(row) = row else { continue };
        let (row, faults) = row.with_context(|| posed.name)?;
        tally.add(&row);
        faults
            .into_iter()
            .for_each(|fault| sheet.fault(format!("solver, {}: {fault}", posed.name)));
        table.row(row.cells(posed.name));
    }
    sheet.section("Hard cases: solver", format!("{INTRODUCTION}\n\n{table}"));
    tally.judge(sheet);
    Ok(())
}

/// None for invalid clouds and empty ones, which make no problem.
fn of_clouds(case: &HardCase) -> Option<Posed> {
    if !case.valid || case.cloud_a.is_empty() || case.cloud_b.is_empty() {
        return None;
    }
    let a = thinned(&case.cloud_a, &case.covariance_a);
    let b = thinned(&case.cloud_b, &case.covariance_b);
    let unit_box = UnitBox::around(a.iter().chain(&b))?;
    let (penalty_a, penalty_b) = balanced_penalties(PENALTY, a.len(), b.len());
    let sides = [(a, Class::A, penalty_a), (b, Class::B, penalty_b)];
    let samples = sides.iter().flat_map(|(points, class, penalty)| {
        let (class, penalty) = (*class, *penalty);
        points.iter().map(move |&point| Sample { point, class, radius: 1.0, penalty })
    });
    let samples = samples.map(|s| unit_box.sample_inside(&s)).collect();
    Some(Posed { name: case.name, samples, gamma: GAMMA })
}

fn thinned(points: &[Point3], covariances: &[Matrix3]) -> Vec<UncertainPoint> {
    let every = points.len().div_ceil(MOST);
    let all = points.iter().zip(covariances).step_by(every);
    all.map(|(&mean, matrix)| UncertainPoint {
        mean,
        covariance: Covariance::from_symmetric(matrix),
    })
    .collect()
}

fn of_problem(problem: &HardProblem) -> Posed {
    let side = |class, points: &[UncertainPoint], radii: &[f64]| {
        let pairs = points.iter().zip(radii);
        pairs
            .map(|(&point, &radius)| Sample { point, class, radius, penalty: problem.penalty })
            .collect::<Vec<_>>()
    };
    let mut samples = side(Class::A, &problem.points_a, &problem.radii_a);
    samples.extend(side(Class::B, &problem.points_b, &problem.radii_b));
    Posed { name: problem.name, samples, gamma: problem.gamma }
}

/// What solving one problem gave.
struct Row {
    solved: Solved,
    /// Relative difference of the primal values, where Clarabel converges.
    primal: Option<f64>,
    /// Largest difference of a probability, where both determine them.
    probability: Option<f64>,
    seconds: f64,
}

impl Row {
    /// At most how far the classifier is from the optimum, as a part of its own size: the objective
    /// is strongly convex in w, so |w − w*|² is at most twice the gap.
    fn classifier_error(&self) -> f64 {
        let solution = &self.solved.solution;
        let gap = solution.relative_gap * solution.primal;
        if gap == 0.0 { 0.0 } else { (2.0 * gap / solution.squared_norm).sqrt() }
    }

    fn cells(&self, name: &str) -> [String; 9] {
        let solution = &self.solved.solution;
        let or_none = |value: Option<f64>| value.map_or("none".into(), small);
        [
            name.into(),
            format!("{:?}", solution.status),
            format!("{:?}", solution.rung),
            solution.effort.smo_steps.to_string(),
            small(solution.relative_gap),
            small(self.classifier_error()),
            or_none(self.primal),
            or_none(self.probability),
            milliseconds(self.seconds),
        ]
    }
}

fn solve(posed: &Posed) -> Result<(Row, Vec<String>)> {
    let start = Instant::now();
    let solved = Solved::new(&posed.samples, posed.gamma).context("not a problem")?;
    let seconds = start.elapsed().as_secs_f64();
    let reference =
        Solver::try_new(Settings { relative_gap: RELATIVE_GAP, ..Settings::default() })?
            .solve_with_clarabel(&solved.problem);
    let of_reference = probabilities(&posed.samples, &solved.problem, &reference);
    let both = !solved.is_undecided() && reference.relative_gap <= RELATIVE_GAP;
    let primal = both
        .then(|| (solved.solution.primal - reference.primal).abs() / solved.solution.primal.abs());
    let probability = largest_difference(&solved.probabilities, &of_reference);
    let faults = faults(posed, &solved, primal);
    Ok((Row { solved, primal, probability: probability.filter(|_| both), seconds }, faults))
}

/// What must hold of any solution.
fn faults(posed: &Posed, solved: &Solved, primal: Option<f64>) -> Vec<String> {
    let (n, solution) = (posed.samples.len(), &solved.solution);
    let mut faults = Vec::new();
    let numbers = [solution.bias, solution.primal, solution.dual, solution.relative_gap];
    let multipliers = solution.alpha.iter().chain(solution.v.iter().flatten());
    if !numbers.iter().chain(multipliers).all(|v| v.is_finite()) {
        faults.push("a number of the solution is not finite".into());
    }
    // The automatic budget, and twice the polish after an interior point method.
    if solution.effort.smo_steps > n * n / 2 + 50 + 20 * n {
        faults.push(format!("{} steps for {n} points", solution.effort.smo_steps));
    }
    let in_range = |p: &f64| (0.0..=1.0).contains(p);
    if !solved.probabilities.iter().flatten().all(in_range) {
        faults.push("a probability is not one".into());
    }
    // Each may be off by its own gap.
    if primal.is_some_and(|difference| difference > 2.0 * RELATIVE_GAP) {
        faults.push("the primal value differs from Clarabel's".into());
    }
    faults
}

#[derive(Default)]
struct Tally {
    solved: usize,
    converged: usize,
    fell_back: usize,
    compared: usize,
    worst_primal: f64,
}

impl Tally {
    fn add(&mut self, row: &Row) {
        self.solved += 1;
        self.converged += usize::from(!row.solved.is_undecided());
        self.fell_back += usize::from(row.solved.fell_back());
        if let Some(primal) = row.primal {
            self.compared += 1;
            self.worst_primal = self.worst_primal.max(primal);
        }
    }

    fn judge(&self, sheet: &mut Sheet) {
        sheet.goal(
            "hard cases: a gap of 1e-4, or a fallback that is reported",
            format!(
                "{} of {} reach it, {} by the fallback",
                self.converged, self.solved, self.fell_back
            ),
            self.converged == self.solved,
        );
        sheet.goal(
            "hard cases: the ladder agrees with Clarabel where both converge",
            format!(
                "primal values differ by {} at most in {} cases",
                small(self.worst_primal),
                self.compared
            ),
            self.worst_primal <= 2.0 * RELATIVE_GAP,
        );
    }
}
