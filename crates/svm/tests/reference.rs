//! The ladder against Clarabel on seeded random problems, with the share each rung solved.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use std::collections::BTreeMap;

use crate::support::{Scene, Shape, Stream, middle, objectives, settings, solver};
use cloudtouch_geom::Point3;
use cloudtouch_svm::{Classifier, Kernel, Problem, Rung, Sample, Settings, Status};

struct Case {
    samples: Vec<Sample>,
    kernel: Kernel,
    gamma: Option<f64>,
    cell: (&'static str, &'static str, &'static str),
}

fn random_case(seed: u64, smallest: usize, largest: usize) -> Case {
    let mut stream = Stream::new(seed);
    let gamma = (stream.unit() < 0.75).then(|| stream.log_range(1e-2, 1e2));
    let penalty = stream.log_range(1e-1, 1e4);
    let gap = stream.range(-0.1, 0.3);
    let noise = match stream.below(5) {
        0 => 0.0,
        // Larger than the gap: with r ≥ 1 the ellipsoids overlap.
        1 => stream.range(1.0, 2.0) * gap.abs().max(0.05),
        _ => stream.log_range(1e-3, 0.1),
    };
    let shape = [Shape::Cap, Shape::Wedge, Shape::CrossingSheet, Shape::Blob][stream.below(4)];
    let size =
        |stream: &mut Stream| stream.log_range(smallest as f64, largest as f64 + 1.0) as usize;
    let scene = Scene {
        shape,
        count_a: size(&mut stream),
        count_b: size(&mut stream),
        gap,
        noise,
        anisotropic: stream.unit() < 0.6,
        radius: stream.range(0.3, 4.0),
        penalty,
    };
    let mut samples = scene.samples(&mut stream);
    if stream.unit() < 0.3 {
        // Exact and uncertain points mixed, as where a mesh meets a cloud.
        for sample in samples.iter_mut().step_by(3) {
            sample.radius = 0.0;
        }
    }
    let cell = (
        match gamma {
            None => "linear",
            Some(g) if g < 0.3 => "gamma < 0.3",
            Some(g) if g < 10.0 => "gamma < 10",
            Some(_) => "gamma >= 10",
        },
        if penalty < 3.0 {
            "C < 3"
        } else if penalty < 300.0 {
            "C < 300"
        } else {
            "C >= 300"
        },
        if noise == 0.0 {
            "exact"
        } else if noise * scene.radius < 0.03 {
            "small"
        } else {
            "large"
        },
    );
    let kernel = gamma.map_or(Kernel::Linear, |gamma| Kernel::Gaussian { gamma });
    Case { samples, kernel, gamma, cell }
}

#[derive(Default)]
struct Tally {
    problems: usize,
    smo: usize,
    interior: usize,
    clarabel: usize,
    collapsed: usize,
    undecided: usize,
}

fn compare(cases: impl Iterator<Item = Case>) {
    let tight = settings(1e-8);
    let reported = settings(1e-4);
    let tighter = settings(1e-9);
    let mut cells: BTreeMap<_, Tally> = BTreeMap::new();
    let mut failures = Vec::new();
    let (mut worst_primal, mut worst_function) = (0.0_f64, 0.0_f64);
    let mut reference_gap = 0.0_f64;
    let mut at_reported = [0; 3];
    for (number, case) in cases.enumerate() {
        let n = case.samples.len();
        let problem = Problem::new(&case.samples, case.kernel).unwrap();
        let ours = problem.solve(&tight).unwrap();
        let reference = solver(&tighter).solve_with_clarabel(&problem);
        let name = format!("case {number} (n {n}, {:?} {:?})", case.kernel, case.cell);
        at_reported[problem.solve(&reported).unwrap().rung as usize] += 1;
        reference_gap = reference_gap.max(reference.relative_gap);
        let tally = cells.entry(case.cell).or_default();
        tally.problems += 1;
        tally.smo += usize::from(ours.rung == Rung::Smo);
        tally.interior += usize::from(ours.rung == Rung::InteriorPoint);
        tally.clarabel += usize::from(ours.rung == Rung::Clarabel);
        tally.collapsed += usize::from(ours.status == Status::Collapsed);
        tally.undecided +=
            usize::from(!matches!(ours.status, Status::Converged | Status::Collapsed));

        // What a solution claims is what the paper's formulas give for it.
        for solution in [&ours, &reference] {
            let (primal, dual) = objectives(
                &case.samples,
                case.gamma,
                &solution.alpha,
                &solution.v,
                &middle(&case.samples),
                solution.bias,
            );
            let off = (primal - solution.primal).abs().max((dual - solution.dual).abs());
            if off > 1e-7 * solution.primal {
                failures.push(format!(
                    "{name}: objectives are off by {off:.1e} of {:.3e}",
                    solution.primal
                ));
            }
        }
        let off = (ours.primal - reference.primal).abs() / reference.primal;
        worst_primal = worst_primal.max(off);
        if off > 1e-5 || ours.dual > reference.primal * (1.0 + 1e-9) {
            failures.push(format!(
                "{name}: primal {:.9e} ({:?} {:?} gap {:.1e}), Clarabel {:.9e} (gap {:.1e})",
                ours.primal,
                ours.rung,
                ours.status,
                ours.relative_gap,
                reference.primal,
                reference.relative_gap
            ));
        }
        if ours.rung != Rung::Smo {
            // Where Clarabel itself was the fallback the comparison above proves nothing, so that
            // SMO's own bounds must enclose the optimum whenever SMO was not enough.
            let smo = problem.solve(&Settings { fallback: false, ..tight }).unwrap();
            let slack = 1e-9 * reference.primal;
            if smo.dual > reference.primal + slack || smo.primal < reference.dual - slack {
                failures.push(format!("{name}: SMO's bounds exclude the optimum"));
            }
        }
        let pair = (Classifier::new(&problem, &ours), Classifier::new(&problem, &reference));
        if let (Ok(f), Ok(g)) = pair {
            let (mut difference, mut scale) = (0.0_f64, 1.0_f64);
            for cell in 0..125 {
                let at = |k: i32| f64::from(k) * 0.25 - 0.5;
                let point = Point3::new(at(cell % 5), at(cell / 5 % 5), at(cell / 25));
                let (fx, gx) = (f.value(&point), g.value(&point));
                difference = difference.max((fx - gx).abs());
                scale = scale.max(gx.abs());
            }
            worst_function = worst_function.max(difference / scale);
            if difference > 1e-3 * scale {
                failures.push(format!(
                    "{name}: f differs by {difference:.1e} on a scale of {scale:.1e}"
                ));
            }
        }
    }
    println!(
        "gamma        penalty   noise  problems   smo  interior  Clarabel  collapsed  not converged"
    );
    let mut all = Tally::default();
    for ((gamma, penalty, noise), t) in &cells {
        println!(
            "{gamma:<12} {penalty:<9} {noise:<6} {:>8} {:>5} {:>9} {:>9} {:>10} {:>14}",
            t.problems, t.smo, t.interior, t.clarabel, t.collapsed, t.undecided
        );
        all.problems += t.problems;
        all.smo += t.smo;
        all.interior += t.interior;
        all.clarabel += t.clarabel;
        all.collapsed += t.collapsed;
        all.undecided += t.undecided;
    }
    println!(
        "all {}: smo {}, interior point {}, Clarabel {}, collapsed {}, not converged {}",
        all.problems, all.smo, all.interior, all.clarabel, all.collapsed, all.undecided
    );
    println!("at 1e-4 instead of 1e-8: [smo, interior point, Clarabel] = {at_reported:?}");
    println!(
        "worst primal {worst_primal:.1e}, worst f {worst_function:.1e}, worst Clarabel gap {reference_gap:.1e}"
    );
    assert!(
        failures.is_empty(),
        "{} of {}:\n{}",
        failures.len(),
        all.problems,
        failures.join("\n")
    );
}

/// `cargo test -p cloudtouch-svm --features clarabel --test suite reference:: -- --nocapture` prints the shares by cell.
#[test]
fn ladder_and_clarabel_agree_on_random_problems() {
    let small = (0..470).map(|seed| random_case(seed, 2, 24));
    let larger = (470..500).map(|seed| random_case(seed, 24, 60));
    let large = (500..504).map(|seed| random_case(seed, 100, 100));
    let largest = std::iter::once(random_case(504, 200, 200));
    compare(small.chain(larger).chain(large).chain(largest));
}

/// `cargo test --release -p cloudtouch-svm --features clarabel --test suite reference:: -- --ignored --nocapture`: minutes.
#[test]
#[ignore = "Clarabel takes minutes on the large ones"]
fn ladder_and_clarabel_agree_on_many_and_large_problems() {
    let small = (1000..2000).map(|seed| random_case(seed, 2, 30));
    let larger = (2000..2040).map(|seed| random_case(seed, 60, 100));
    let largest = (2040..2046).map(|seed| random_case(seed, 200, 200));
    compare(small.chain(larger).chain(largest));
}

#[test]
fn a_problem_too_large_for_clarabel_is_said_to_be() {
    let scene = Scene {
        shape: Shape::Cap,
        count_a: 601,
        count_b: 1,
        gap: 0.1,
        noise: 0.01,
        anisotropic: false,
        radius: 1.0,
        penalty: 1.0,
    };
    let samples = scene.samples(&mut Stream::new(1));
    let problem = Problem::new(&samples, Kernel::Linear).unwrap();
    let solution = solver(&settings(1e-3)).solve_with_clarabel(&problem);
    assert_eq!(
        (solution.status, solution.ends.clarabel),
        (Status::TooLarge, Some(Status::TooLarge))
    );
}
