//! Units of length and tiny kernel widths change nothing.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use crate::support::{Difficulty, cell, settings};
use cloudtouch_geom::{Point3, UncertainPoint};
use cloudtouch_svm::{Classifier, Kernel, Problem, Sample, Status};

fn in_units(samples: &[Sample], scale: f64) -> Vec<Sample> {
    samples
        .iter()
        .map(|s| Sample {
            point: UncertainPoint {
                mean: Point3::from(s.point.mean.coords * scale),
                covariance: s.point.covariance.scaled(scale),
            },
            penalty: s.penalty / (scale * scale),
            ..*s
        })
        .collect()
}

#[test]
fn a_plane_in_other_units_is_found_in_the_same_steps() {
    for difficulty in [Difficulty::Easy, Difficulty::Contact, Difficulty::Hard] {
        for seed in 0..6 {
            let (samples, _) = cell(difficulty, 12, seed);
            let solve = |scale: f64| {
                let problem = Problem::new(&in_units(&samples, scale), Kernel::Linear).unwrap();
                problem.solve(&settings(1e-6)).unwrap()
            };
            // Powers of two: not a bit is rounded differently.
            let here = solve(1.0);
            for exponent in [-40, -20, 20, 40] {
                let there = solve(2_f64.powi(exponent));
                let name = format!("{difficulty:?} {seed} 2^{exponent}");
                assert_eq!((here.status, here.rung), (there.status, there.rung), "{name}");
                assert_eq!(here.effort, there.effort, "{name}");
            }
        }
    }
}

/// exp(−γd²) = 1 − γd² + …: with Σcα = 0 the constant drops out, and 2γ x·y is left.
#[test]
fn a_wide_gaussian_is_a_plane() {
    for seed in 0..6 {
        let (samples, _) = cell(Difficulty::Easy, 12, seed);
        let settings = settings(1e-6);
        let linear = Problem::new(&samples, Kernel::Linear).unwrap();
        let plane = linear.solve(&settings).unwrap();
        if plane.status != Status::Converged {
            continue;
        }
        for gamma in [1e-6, 1e-9, 1e-12, 1e-15, 1e-18] {
            let wide: Vec<Sample> = samples
                .iter()
                .map(|s| Sample { penalty: s.penalty / (2.0 * gamma), ..*s })
                .collect();
            let problem = Problem::new(&wide, Kernel::Gaussian { gamma }).unwrap();
            let solution = problem.solve(&settings).unwrap();
            assert_eq!(
                solution.status,
                Status::Converged,
                "seed {seed} gamma {gamma}: {}",
                solution.relative_gap
            );
            let f = Classifier::new(&linear, &plane).unwrap();
            let g = Classifier::new(&problem, &solution).unwrap();
            for s in &samples {
                let [p, q] = [&f, &g].map(|f| f.probability(&s.point, s.class).unwrap());
                assert!((p - q).abs() < 1e-2, "seed {seed} gamma {gamma}: {p} {q}");
            }
        }
    }
}
