//! What a solution says of its distance from the optimum holds.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use crate::support::{Difficulty, cell, settings};
use cloudtouch_svm::{Classifier, Kernel, Problem, Sample, UnitBox};
use proptest::prelude::*;

/// Loose and tight classifiers of one problem, where both are to be had; the tight one stands for the
/// optimum, and what is left of its own gap is counted. Whether both were.
fn check(samples: &[Sample], kernel: Kernel, gap: f64) -> bool {
    let problem = Problem::new(samples, kernel).unwrap();
    let loose = problem.solve(&settings(gap)).unwrap();
    let tight = problem.solve(&settings(1e-10)).unwrap();
    let both = [&loose, &tight].map(|solution| Classifier::new(&problem, solution));
    let [Ok(f), Ok(g)] = both else { return false };
    for (i, s) in samples.iter().enumerate() {
        let at = s.point.mean;
        let [p, q] = [&f, &g].map(|f| f.probability(&s.point, s.class).unwrap());
        let [least, most] = f.probability_bounds(&s.point, s.class).unwrap();
        assert!(least <= p && p <= most, "sample {i}: {p} outside [{least}, {most}]");
        let [low, high] = f.value_bounds(&at);
        let [low_tight, high_tight] = g.value_bounds(&at);
        // The two intervals have the optimum in common.
        assert!(low <= high_tight && low_tight <= high, "sample {i}");
        let name = format!("sample {i}: {q} outside [{least}, {most}]");
        let left = tight.error.probability;
        assert!(least - left <= q && q <= most + left, "{name}");
        if s.point.covariance.max_std() > 0.0 {
            let off = loose.error.probability + left;
            assert!((p - q).abs() <= off, "sample {i}: {p} and {q}, {off}");
        }
    }
    true
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_optimum_lies_within_the_bounds(
        seed in 0..10_000_u64,
        log_penalty in -5.0..4.0_f64,
        log_gamma in -4.0..1.5_f64,
        log_gap in -6.0..-1.2_f64,
        shape in 0..4,
    ) {
        let difficulty = [Difficulty::Easy, Difficulty::Contact, Difficulty::Hard][seed as usize % 3];
        let (mut samples, _) = cell(difficulty, 4 + (seed % 12) as usize, seed);
        for (i, sample) in samples.iter_mut().enumerate() {
            sample.penalty = 10_f64.powf(log_penalty) * if i % 3 == 0 { 0.7 } else { 1.0 };
            // All exact in training, or some.
            sample.radius *= f64::from(shape > 0 && !(shape == 1 && i % 2 == 0));
        }
        let gamma = 10_f64.powf(log_gamma);
        let kernel = if shape == 3 { Kernel::Linear } else { Kernel::Gaussian { gamma } };
        prop_assume!(check(&samples, kernel, 10_f64.powf(log_gap)));
    }
}

#[test]
fn the_error_of_probabilities_was_zero_for_exact_training_and_wide_ranges() {
    for radius in [0.0, 1.0] {
        for seed in 0..20 {
            let (samples, gamma) = cell(Difficulty::Contact, 12, seed);
            let samples: Vec<Sample> =
                samples.into_iter().map(|s| Sample { radius, ..s }).collect();
            let kernel = Kernel::Gaussian { gamma };
            let solution = Problem::new(&samples, kernel).unwrap().solve(&settings(1e-3)).unwrap();
            assert!(solution.error.probability > 0.0);
            assert!(check(&samples, kernel, 2e-2), "seed {seed}");
        }
    }
}

#[test]
fn bounds_close_as_the_gap_does() {
    for seed in 0..10 {
        let (samples, gamma) = cell(Difficulty::Easy, 12, seed);
        let problem = Problem::new(&samples, Kernel::Gaussian { gamma }).unwrap();
        let error = |gap| problem.solve(&settings(gap)).unwrap().error.probability;
        let [loose, tight] = [error(1e-3), error(1e-10)];
        assert!(tight < 2e-2 && tight <= loose, "seed {seed}: {loose} {tight}");
    }
}

#[test]
fn bounds_of_points_outside_the_unit_box_are_those_inside() {
    let (samples, gamma) = cell(Difficulty::Contact, 12, 4);
    let unit_box = UnitBox::around(samples.iter().map(|s| &s.point)).unwrap();
    let inside: Vec<Sample> = samples.iter().map(|s| unit_box.sample_inside(s)).collect();
    let problem = Problem::new(&inside, Kernel::Gaussian { gamma }).unwrap();
    let f = Classifier::new(&problem, &problem.solve(&settings(1e-6)).unwrap()).unwrap();
    let g = f.clone().outside(unit_box);
    for (outer, inner) in samples.iter().zip(&inside) {
        let p = g.probability_bounds(&outer.point, outer.class).unwrap();
        let q = f.probability_bounds(&inner.point, inner.class).unwrap();
        assert!((p[0] - q[0]).abs() + (p[1] - q[1]).abs() < 1e-9, "{p:?} {q:?}");
    }
}
