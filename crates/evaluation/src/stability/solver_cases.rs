//! The catalogue through the solver, beside Clarabel.

use anyhow::{Context, Result};
use cloudtouch_geom::{Matrix3, Point3, UncertainPoint};
use cloudtouch_testkit::hard_cases::{HardCase, hard_cases, hard_problems};

use super::{
    shapes::uncertain,
    sheet::{Sheet, small},
    solver::{GAMMA, PENALTY, Posed, RELATIVE_GAP, Solved},
};
use crate::{page::Section, table::Table};

/// Points of a side at most: what a leaf holds, and Clarabel can answer.
const MOST: usize = 40;

/// What the section says before its table.
const INTRODUCTION: &str = "Clouds thinned to 40 points a side, in the unit box, with the settings \
of a default query; then settings of the solver out of the ordinary on harmless clouds. *Gap* is the \
relative gap between primal and dual, recomputed from the multipliers; 1e-4 is asked for. *Solver* \
says who answered: SMO, the dense interior point method, or Clarabel as the fallback. *Difference* is \
that of the primal value from that of Clarabel alone, relative; `none` where Clarabel does not reach \
the tolerance. `Collapsed` is an answer: no surface separates the pair.";

/// Solves everything and adds the section.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let mut table = Table::new(["case", "status", "solver", "steps", "gap", "difference"]);
    let clouds = hard_cases();
    let of_clouds = clouds.iter().filter_map(|case| Some((case.name, of_clouds(case)?)));
    let problems = hard_problems();
    let of_problems = problems.iter().map(|problem| (problem.name, Posed::of_problem(problem)));
    let (mut solved, mut converged, mut fell_back) = (0, 0, 0);
    let mut differences = Vec::new();
    for (name, posed) in of_clouds.chain(of_problems) {
        let full = format!("solver, {name}");
        let Some(row) = sheet.guard(&full, || solve(&posed)) else { continue };
        let (answer, primal) = row.with_context(|| full.clone())?;
        answer.faults().iter().for_each(|fault| sheet.fault(format!("{full}: {fault}")));
        // Each may be off by its own gap.
        if primal.is_some_and(|difference| difference > 2.0 * RELATIVE_GAP) {
            sheet.fault(format!("{full}: the primal value differs from Clarabel's"));
        }
        solved += 1;
        converged += usize::from(!answer.is_undecided());
        fell_back += usize::from(answer.fell_back());
        differences.extend(primal);
        table.row([
            name.to_owned(),
            answer.status(),
            answer.rung(),
            answer.steps().to_string(),
            small(answer.gap()),
            primal.map_or("none".into(), small),
        ]);
    }
    sheet.sections.push(Section::new("Hard cases: solver").text(INTRODUCTION).text(table));
    sheet.goal(
        "hard cases: a gap of 1e-4, or a fallback that is reported",
        format!("{converged} of {solved} reach it, {fell_back} by the fallback"),
        converged == solved,
    );
    let worst = differences.iter().copied().fold(0.0, f64::max);
    sheet.goal(
        "hard cases: the ladder agrees with Clarabel where both converge",
        format!("primal values differ by {} at most in {} cases", small(worst), differences.len()),
        worst <= 2.0 * RELATIVE_GAP,
    );
    Ok(())
}

/// The solution, and how its primal value differs from Clarabel's.
fn solve(posed: &Posed) -> Result<(Solved, Option<f64>)> {
    let solved = Solved::new(posed)?;
    let difference = solved.against_clarabel()?;
    Ok((solved, difference))
}

/// None for invalid clouds and empty ones, which make no problem.
fn of_clouds(case: &HardCase) -> Option<Posed> {
    if !case.valid || case.cloud_a.is_empty() || case.cloud_b.is_empty() {
        return None;
    }
    let thinned = |points: &[Point3], covariances: &[Matrix3]| -> Vec<UncertainPoint> {
        let every = points.len().div_ceil(MOST);
        uncertain(points, covariances).into_iter().step_by(every).collect()
    };
    let a = thinned(&case.cloud_a, &case.covariance_a);
    let b = thinned(&case.cloud_b, &case.covariance_b);
    Posed::of_leaves([&a, &b], GAMMA, PENALTY)
}
