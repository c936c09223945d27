//! The catalogue of hard cases as leaf problems, beside Clarabel, and settings of the solver out of the
//! ordinary on harmless clouds.

use cloudtouch::QuerySettings;
use cloudtouch::geom::{Covariance, Matrix3, Point3, UncertainPoint};
use cloudtouch_svm::{
    Class, Kernel, Problem, Rung, Sample, Settings, Solver, Status, UnitBox, balanced_penalties,
};
use cloudtouch_testkit::hard_cases::{HardCase, HardProblem, hard_cases, hard_problems};

/// The relative gap between primal and dual that is asked for: that of reported figures.
const RELATIVE_GAP: f64 = 1e-4;
/// Points of a side at most: what a leaf holds, and Clarabel can answer.
const MOST: usize = 40;

/// Every one reaches the gap, or says that nothing separates the sides, within its budget of steps and
/// without the fallback; primal values are Clarabel's where both have one.
#[test]
fn every_hard_leaf_problem_is_solved_as_clarabel_solves_it() {
    let gamma = QuerySettings::default().gamma;
    let clouds =
        hard_cases().into_iter().filter_map(|case| Some((case.name, of_clouds(&case)?, gamma)));
    let problems = hard_problems().into_iter().map(|p| (p.name, of_problem(&p), p.gamma));
    let (mut wrong, mut compared, mut most_steps, mut worst) = (Vec::new(), 0, 0.0_f64, 0.0_f64);
    let all: Vec<_> = clouds.chain(problems).collect();
    for (name, samples, gamma) in &all {
        let problem = Problem::new(samples, Kernel::Gaussian { gamma: *gamma }).unwrap();
        let settings = Settings { relative_gap: RELATIVE_GAP, ..Settings::default() };
        let ours = problem.solve(&settings).unwrap();
        let reference = Solver::new(settings).unwrap().solve_with_clarabel(&problem);
        // The automatic budget, and twice the polish after an interior point method.
        let (n, steps) = (samples.len(), ours.effort.smo_steps);
        let of_budget = steps as f64 / (n * n / 2 + 50 + 20 * n) as f64;
        most_steps = most_steps.max(of_budget);
        let is_answer = matches!(ours.status, Status::Converged | Status::Collapsed);
        if !is_answer || ours.rung == Rung::Clarabel || of_budget > 1.0 {
            wrong.push(format!("{name}: {:?} by {:?}, {steps} steps", ours.status, ours.rung));
        }
        if is_answer && reference.relative_gap <= RELATIVE_GAP {
            compared += 1;
            let off = (ours.primal - reference.primal).abs() / ours.primal.abs();
            worst = worst.max(off);
            // Each may be off by its own gap.
            if off > 2.0 * RELATIVE_GAP {
                wrong.push(format!("{name}: {} and Clarabel {}", ours.primal, reference.primal));
            }
        }
    }
    println!(
        "{} hard leaf problems, {:.0} % of the budget of steps at most; of {compared} primal values \
         {worst:.0e} at most off Clarabel's",
        all.len(),
        100.0 * most_steps
    );
    assert!(wrong.is_empty() && compared > all.len() / 2, "{}", wrong.join("\n"));
}

/// As a default query poses them, in their unit box and with penalties balanced; none for invalid clouds
/// and empty ones, which make no problem.
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
    let QuerySettings { penalty, ellipsoid_radius, .. } = QuerySettings::default();
    let unit_box = UnitBox::around(a.iter().chain(&b))?;
    let penalties = balanced_penalties(penalty, a.len(), b.len()).into();
    let all = samples([&a, &b], [ellipsoid_radius; 2], penalties);
    Some(all.iter().map(|sample| unit_box.sample_inside(sample)).collect())
}

/// As it is, with a radius for each point.
fn of_problem(problem: &HardProblem) -> Vec<Sample> {
    let sides = [&problem.points_a[..], &problem.points_b];
    let all = samples(sides, [0.0; 2], [problem.penalty; 2]);
    let radii = problem.radii_a.iter().chain(&problem.radii_b);
    all.into_iter().zip(radii).map(|(sample, &radius)| Sample { radius, ..sample }).collect()
}

/// The points of both sides as samples of a radius (r) and a penalty (C) of each side.
fn samples(sides: [&[UncertainPoint]; 2], radii: [f64; 2], penalties: [f64; 2]) -> Vec<Sample> {
    let of = |side: usize| {
        let class = [Class::A, Class::B][side];
        let (radius, penalty) = (radii[side], penalties[side]);
        sides[side].iter().map(move |&point| Sample { point, class, radius, penalty })
    };
    of(0).chain(of(1)).collect()
}
