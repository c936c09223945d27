//! The catalogue through the solver, beside Clarabel.

use anyhow::Context;
use cloudtouch::QuerySettings;
use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint};
use cloudtouch_svm::{Kernel, Problem, Rung, Sample, Settings, Solver, Status};
use cloudtouch_testkit::hard_cases::{HardCase, HardProblem, hard_cases, hard_problems};

use crate::leaf;
use crate::report::{Findings, Section, Target};

/// The relative gap that solves are asked for: that of reported figures.
const RELATIVE_GAP: f64 = 1e-4;
/// Points of a side at most: what a leaf holds, and Clarabel can answer.
const MOST: usize = 40;

const INTRODUCTION: &str = "The clouds of the hard cases below, thinned to 40 points a side, in the \
unit box, with the settings of a default query; then settings of the solver out of the ordinary on \
harmless clouds. The relative gap between primal and dual is recomputed from the multipliers; 1e-4 is \
asked for. Where no surface separates the pair, the solver says so, which is an answer. The fallback is \
Clarabel.";

/// Solves everything.
pub(super) fn measure() -> Findings {
    let gamma = QuerySettings::default().gamma;
    let clouds =
        hard_cases().into_iter().filter_map(|case| Some((case.name, of_clouds(&case)?, gamma)));
    let problems = hard_problems().into_iter().map(|p| (p.name, of_problem(&p), p.gamma));
    let (mut solved, mut converged, mut fell_back, mut most_steps) = (0, 0, 0, 0.0_f64);
    let mut differences = Vec::new();
    for (name, samples, gamma) in clouds.chain(problems) {
        let problem = Problem::try_new(&samples, Kernel::Gaussian { gamma }).context(name)?;
        let settings = Settings { relative_gap: RELATIVE_GAP, ..Settings::default() };
        let ours = problem.solve(&settings).context(name)?;
        let reference = Solver::try_new(settings)?.solve_with_clarabel(&problem);
        let is_answer = matches!(ours.status, Status::Converged | Status::Collapsed);
        if is_answer && reference.relative_gap <= RELATIVE_GAP {
            differences.push((ours.primal - reference.primal).abs() / ours.primal.abs());
        }
        // The automatic budget, and twice the polish after an interior point method.
        let (n, steps) = (samples.len(), ours.effort.smo_steps);
        most_steps = most_steps.max(steps as f64 / (n * n / 2 + 50 + 20 * n) as f64);
        solved += 1;
        converged += usize::from(is_answer);
        fell_back += usize::from(ours.rung == Rung::Clarabel);
    }
    let worst = differences.iter().copied().fold(0.0, f64::max);
    let targets = vec![
        Target::new(
            "solver: a gap of 1e-4, or a fallback that is reported",
            format!("{converged} of {solved} reach it, {fell_back} by the fallback"),
            converged == solved,
        ),
        // Each may be off by its own gap.
        Target::new(
            "solver: primal values are Clarabel's where both converge",
            format!("{worst:.0e} at most in {} cases", differences.len()),
            worst <= 2.0 * RELATIVE_GAP,
        ),
        Target::new(
            "solver: steps within the budget",
            format!("{:.0} % of it at most", 100.0 * most_steps),
            most_steps <= 1.0,
        ),
    ];
    Ok((Section::new("Hard cases: solver").text(INTRODUCTION), targets))
}

/// None for invalid clouds and empty ones, which make no problem.
fn of_clouds(case: &HardCase) -> Option<Vec<Sample>> {
    if !case.valid || case.cloud_a.is_empty() || case.cloud_b.is_empty() {
        return None;
    }
    let thinned = |points: &[Point3], covariances: &[Matrix3]| -> Vec<UncertainPoint> {
        let point = |(&mean, covariance)| UncertainPoint {
            mean,
            covariance: Covariance::from_symmetric(covariance),
        };
        let every = points.len().div_ceil(MOST);
        points.iter().zip(covariances).map(point).step_by(every).collect()
    };
    let a = thinned(&case.cloud_a, &case.covariance_a);
    let b = thinned(&case.cloud_b, &case.covariance_b);
    leaf::posed([&a, &b], QuerySettings::default().ellipsoid_radius)
}

/// As it is, with a radius for each point.
fn of_problem(problem: &HardProblem) -> Vec<Sample> {
    let sides = [&problem.points_a[..], &problem.points_b];
    let samples = leaf::samples(sides, 0.0, [problem.penalty; 2]);
    let radii = problem.radii_a.iter().chain(&problem.radii_b);
    samples.into_iter().zip(radii).map(|(sample, &radius)| Sample { radius, ..sample }).collect()
}
