//! Times the solver on seeded leaf problems of rising difficulty and prints one row a cell.
//!
//! `cargo run --release -p cloudtouch-svm --example solver_cells [RELATIVE_GAP]`

use std::time::Instant;

use cloudtouch_geom::UncertainPoint;
use cloudtouch_svm::{
    Class, DEFAULT_KAPPA_MAX, Kernel, Problem, Rung, Sample, Settings, Status, separate,
};

#[allow(dead_code, reason = "tests use more of it")]
#[path = "../tests/support/mod.rs"]
mod support;
use support::{Difficulty, cell, settings};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gap = std::env::args().nth(1).map_or(Ok(1e-4), |text| text.parse())?;
    let settings = settings(gap);
    println!("relative gap {gap:e}; times in microseconds");
    println!(
        "cell             median      p90  steps  smo only  interior  clarabel  unsolved  collapsed"
    );
    for per_side in [20, 40, 100] {
        for difficulty in [Difficulty::Easy, Difficulty::Contact, Difficulty::Hard] {
            let count = if per_side == 100 { 15 } else { 51 };
            let mut times = Vec::new();
            let mut smo_times = Vec::new();
            let mut steps = Vec::new();
            let (mut dense, mut clarabel, mut unsolved, mut collapsed) = (0, 0, 0, 0);
            for seed in 0..count {
                let (samples, gamma) = cell(difficulty, per_side, seed);
                let start = Instant::now();
                let problem = Problem::new(&samples, Kernel::Gaussian { gamma })?;
                let solution = problem.solve(&settings)?;
                times.push(start.elapsed().as_secs_f64() * 1e6);
                let start = Instant::now();
                let smo = problem.solve(&Settings { fallback: false, ..settings })?;
                smo_times.push(start.elapsed().as_secs_f64() * 1e6);
                steps.push(smo.effort.smo_steps);
                dense += usize::from(solution.rung == Rung::InteriorPoint);
                clarabel += usize::from(solution.rung == Rung::Clarabel);
                let ended = matches!(solution.status, Status::Converged | Status::Collapsed);
                unsolved += usize::from(!ended);
                collapsed += usize::from(solution.status == Status::Collapsed);
            }
            times.sort_by(f64::total_cmp);
            smo_times.sort_by(f64::total_cmp);
            steps.sort_unstable();
            println!(
                "2x{per_side:<4} {:<8} {:>8.0} {:>8.0} {:>6} {:>9.0} {:>6}/{count} {:>6}/{count} {:>6}/{count} {:>7}/{count}",
                format!("{difficulty:?}"),
                times[times.len() / 2],
                times[times.len() * 9 / 10],
                steps[steps.len() / 2],
                smo_times[smo_times.len() / 2],
                dense,
                clarabel,
                unsolved,
                collapsed
            );
        }
    }
    time_certificates();
    Ok(())
}

/// Time of the linear certificate, where it reaches the largest κ and where it does not.
fn time_certificates() {
    for difficulty in [Difficulty::Easy, Difficulty::Contact] {
        let (mut reached, mut short) = (Vec::new(), Vec::new());
        for seed in 0..200 {
            let (samples, _) = cell(difficulty, 40, seed);
            let of = |class: Class| -> Vec<UncertainPoint> {
                let own = |s: &&Sample| s.class == class;
                samples.iter().filter(own).map(|s| s.point).collect()
            };
            let (a, b) = (of(Class::A), of(Class::B));
            let start = Instant::now();
            let mut kappa = 0.0;
            for _ in 0..20 {
                kappa = separate(&a, &b, DEFAULT_KAPPA_MAX).map_or(0.0, |plane| plane.kappa);
            }
            let micros = start.elapsed().as_secs_f64() * 1e6 / 20.0;
            if kappa == DEFAULT_KAPPA_MAX { reached.push(micros) } else { short.push(micros) }
        }
        for (name, mut times) in [("kappa reached", reached), ("not reached", short)] {
            times.sort_by(f64::total_cmp);
            if let (Some(median), Some(p90)) =
                (times.get(times.len() / 2), times.get(times.len() * 9 / 10))
            {
                let count = times.len();
                println!(
                    "certificate 2x40 {difficulty:?}, {name}: {count} of 200, median {median:.1}, p90 {p90:.1}"
                );
            }
        }
    }
}
