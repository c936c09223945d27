//! What must hold of every classifier and plane: derivatives, signs, and how answers may move when
//! points or uncertainty are added.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use crate::support::{Difficulty, Stream, cell, settings, solver};
use cloudtouch_geom::{Point3, UncertainPoint, Vector3, seed};
use cloudtouch_svm::{
    Class, Classifier, Kernel, Problem, Sample, Settings, Solution, Status, UnitBox, separate,
};
use proptest::prelude::*;

fn solve(samples: &[Sample], kernel: Kernel) -> (Problem, Solution) {
    let problem = Problem::new(samples, kernel).unwrap();
    let solution = problem.solve(&settings(1e-8)).unwrap();
    (problem, solution)
}

/// A case that says nothing: of too many of these a property test fails.
fn rejected(error: impl ToString) -> TestCaseError {
    TestCaseError::reject(error.to_string())
}

/// A leaf problem with its classifier; rejected where it determines no probabilities.
fn solved(seed: u64) -> Result<(Vec<Sample>, Kernel, Solution, Classifier), TestCaseError> {
    let difficulty = if seed.is_multiple_of(2) { Difficulty::Easy } else { Difficulty::Contact };
    let (samples, gamma) = cell(difficulty, 8 + (seed % 13) as usize, seed);
    let kernel = if seed.is_multiple_of(5) { Kernel::Linear } else { Kernel::Gaussian { gamma } };
    let (problem, solution) = solve(&samples, kernel);
    let f = Classifier::new(&problem, &solution).map_err(rejected)?;
    Ok((samples, kernel, solution, f))
}

fn sides(samples: &[Sample]) -> [Vec<UncertainPoint>; 2] {
    [Class::A, Class::B]
        .map(|class| samples.iter().filter(|s| s.class == class).map(|s| s.point).collect())
}

/// Central differences of `value` around `at`.
fn slope(value: impl Fn(&Point3) -> f64, at: &Point3, step: f64) -> Vector3 {
    Vector3::from_fn(|axis, _| {
        let mut along = Vector3::zeros();
        along[axis] = step;
        (value(&(at + along)) - value(&(at - along))) / (2.0 * step)
    })
}

/// At tiny penalties or kernel widths w is small beside the objective, and a gap that is small there says little of f:
/// that is told. Of what may be read hardly any probability hangs on the tolerance.
#[test]
fn probabilities_that_are_read_do_not_hang_on_the_tolerance() {
    let difference = |index: u64| -> Option<f64> {
        let unit = |k: u64| seed::unit(seed::derive(17, index, k));
        let difficulty =
            [Difficulty::Easy, Difficulty::Contact, Difficulty::Hard][index as usize % 3];
        let (mut samples, _) = cell(difficulty, 4 + (index % 12) as usize, index);
        samples.iter_mut().for_each(|s| s.penalty = 10_f64.powf(7.0 * unit(0) - 5.0));
        let kernel = Kernel::Gaussian { gamma: 10_f64.powf(5.5 * unit(1) - 4.0) };
        let problem = Problem::new(&samples, kernel).unwrap();
        let read = |gap| Classifier::new(&problem, &problem.solve(&settings(gap)).unwrap()).ok();
        let both = [read(1e-3)?, read(1e-8)?];
        let differ = |s: &Sample| {
            let [p, q] = [0, 1].map(|k| both[k].probability(&s.point, s.class).unwrap());
            (p - q).abs()
        };
        Some(samples.iter().map(differ).fold(0.0, f64::max))
    };
    let mut read: Vec<f64> = (0..8000).filter_map(difference).collect();
    read.sort_by(f64::total_cmp);
    assert!(read.len() > 500, "{}", read.len());
    let of = |share: f64| read[(share * (read.len() - 1) as f64) as usize];
    assert!(
        of(0.9) < 0.01 && of(0.995) < 0.05 && of(1.0) < 0.15,
        "{:?}",
        [0.9, 0.995, 1.0].map(of)
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    /// Nor is reading refused where it need not be: these are leaf problems of default settings.
    #[test]
    fn ordinary_problems_determine_probabilities(seed in 0..10_000_u64) {
        let difficulty = if seed.is_multiple_of(2) { Difficulty::Easy } else { Difficulty::Contact };
        let (samples, gamma) = cell(difficulty, 8 + (seed % 13) as usize, seed);
        let problem = Problem::new(&samples, Kernel::Gaussian { gamma }).unwrap();
        let solution = problem.solve(&Settings::default()).unwrap();
        prop_assert_eq!(solution.determined(), Ok(()), "{:?}", solution);
    }

    /// Metres outside the box, box lengths inside: the gradient outside has to be per metre.
    #[test]
    fn gradients_outside_the_unit_box_are_per_metre(seed in 0..10_000_u64, exponent in -3..4_i32) {
        let (samples, gamma) = cell(Difficulty::Contact, 10, seed);
        let scale = 10_f64.powi(exponent);
        let offset = Vector3::new(3.0, -2.0, 1.0) * scale;
        let scaled: Vec<Sample> = samples
            .iter()
            .map(|s| Sample {
                point: UncertainPoint {
                    mean: Point3::from(s.point.mean.coords * scale + offset),
                    covariance: s.point.covariance.scaled(scale),
                },
                ..*s
            })
            .collect();
        let unit_box = UnitBox::around(scaled.iter().map(|s| &s.point)).unwrap();
        let inside: Vec<Sample> = scaled.iter().map(|s| unit_box.sample_inside(s)).collect();
        let (problem, solution) = solve(&inside, Kernel::Gaussian { gamma });
        let f = Classifier::new(&problem, &solution).map_err(rejected)?;
        let g = f.clone().outside(unit_box);
        for s in &scaled {
            let at = s.point.mean;
            let (value, gradient) = g.value_and_gradient(&at);
            let within = unit_box.point_inside(&at);
            let (value_within, gradient_within) = f.value_and_gradient(&within);
            prop_assert!((value - value_within).abs() <= 1e-9 * (1.0 + value.abs()));
            let brought = unit_box.gradient_outside(&gradient_within);
            prop_assert!((gradient - brought).norm() <= 1e-9 * (1.0 + gradient.norm()));
            let measured = slope(|p| g.value(p), &at, 1e-5 * scale);
            // Differences: h²·f''' and the rounding of f over h, both per metre.
            let tolerance = 1e-5 * (gamma / scale + gradient.norm());
            prop_assert!((gradient - measured).norm() <= tolerance, "{} {}", gradient, measured);
        }
    }

    #[test]
    fn swapping_the_classes_turns_value_and_gradient_round(seed in 0..10_000_u64) {
        let (samples, kernel, _, f) = solved(seed)?;
        let swapped: Vec<Sample> =
            samples.iter().map(|s| Sample { class: s.class.opposite(), ..*s }).collect();
        let (problem, solution) = solve(&swapped, kernel);
        let g = Classifier::new(&problem, &solution).unwrap();
        let scale = solution.squared_norm.sqrt().max(1.0);
        for s in &samples {
            let (value, gradient) = f.value_and_gradient(&s.point.mean);
            let (other, turned) = g.value_and_gradient(&s.point.mean);
            // Two gaps of 1e-8 leave |w − w*| up to 1e-4 of the objective's root.
            prop_assert!((value + other).abs() <= 1e-3 * scale, "{} {}", value, other);
            prop_assert!((gradient + turned).norm() <= 1e-2 * scale, "{} {}", gradient, turned);
        }
    }

    /// A point that is on its own side beyond the margin has no say in the optimum.
    #[test]
    fn adding_points_beyond_the_margin(seed in 0..10_000_u64) {
        let (samples, kernel, solution, f) = solved(seed)?;
        let mut stream = Stream::new(seed);
        let mut more = samples.clone();
        for _ in 0..200 {
            let mean = Point3::from(stream.normal_vector() * 0.5);
            let point = UncertainPoint { mean, ..samples[0].point };
            let (value, gradient) = f.value_and_gradient(&mean);
            let class = if value > 0.0 { Class::A } else { Class::B };
            let reach = samples[0].radius * point.covariance.std_along(&gradient);
            // Clearly beyond the margin: f itself is known to about 1e-4.
            if value.abs() - reach > 1.01 && more.len() < samples.len() + 10 {
                more.push(Sample { point, class, ..samples[0] });
            }
        }
        prop_assume!(more.len() > samples.len());
        let (_, with_more) = solve(&more, kernel);
        prop_assert!(
            (solution.primal - with_more.primal).abs() <= 1e-6 * solution.primal,
            "{} became {} with {} points more",
            solution.primal, with_more.primal, more.len() - samples.len()
        );
    }

    /// With the surface given, more uncertainty brings every probability nearer to ½ from its side.
    #[test]
    fn a_larger_covariance_brings_a_probability_towards_one_half(
        seed in 0..10_000_u64,
        factor in 1.0..100.0_f64,
    ) {
        let (samples, _, _, f) = solved(seed)?;
        for s in &samples {
            let wider = UncertainPoint { covariance: s.point.covariance.scaled(factor), ..s.point };
            let p = f.probability(&s.point, s.class).unwrap();
            let q = f.probability(&wider, s.class).unwrap();
            prop_assert!((q - 0.5).abs() <= (p - 0.5).abs() + 1e-12, "{} {}", p, q);
            prop_assert!((p < 0.5) == (q < 0.5) || (p - 0.5).abs() < 1e-9, "{} {}", p, q);
        }
    }

    #[test]
    fn a_warm_start_gives_the_probabilities_of_a_cold_one(
        seed in 0..10_000_u64,
        shift in -0.01..0.01_f64,
    ) {
        let (samples, kernel, before, _) = solved(seed)?;
        let moved: Vec<Sample> = samples
            .iter()
            .map(|s| {
                let by = if s.class == Class::A { shift } else { 0.0 };
                let mean = s.point.mean + Vector3::z() * by;
                Sample { point: UncertainPoint { mean, ..s.point }, ..*s }
            })
            .collect();
        // Two gaps of 1e-8 leave planes apart by more than is asked here, in one of 700.
        let settings = settings(1e-9);
        let problem = Problem::new(&moved, kernel).unwrap();
        let (cold, warm) = (problem.solve(&settings).unwrap(), solver(&settings).solve_from(&problem, &before));
        prop_assert_eq!(cold.status, warm.status);
        if cold.status == Status::Converged {
            let [f, g] = [cold, warm].map(|s| Classifier::new(&problem, &s).unwrap());
            for s in &moved {
                let p = f.probability(&s.point, s.class).unwrap();
                let q = g.probability(&s.point, s.class).unwrap();
                prop_assert!((p - q).abs() < 1e-3, "{} {}", p, q);
            }
        }
    }

    #[test]
    fn a_separating_plane_has_two_sides(seed in 0..10_000_u64, up in 0.0..0.5_f64) {
        let (samples, _) = cell(Difficulty::Easy, 15, seed);
        let [mut a, b] = sides(&samples);
        a.iter_mut().for_each(|p| p.mean.z += up);
        // κ is found to about one part in a thousand whichever way round.
        let (Ok(forth), Ok(back)) = (separate(&a, &b, 50.0), separate(&b, &a, 50.0)) else {
            prop_assert_eq!(separate(&a, &b, 50.0).is_ok(), separate(&b, &a, 50.0).is_ok());
            return Ok(());
        };
        prop_assert!((forth.kappa - back.kappa).abs() <= 5e-3 * forth.kappa);
        prop_assert!((forth.normal.norm() - 1.0).abs() < 1e-12);
        prop_assert!(forth.signed_distance(&forth.point).abs() < 1e-12);
        let measured = slope(|p| forth.signed_distance(p), &Point3::new(0.3, 0.1, -0.2), 1e-3);
        // From A to B the distance, which is positive in A, falls.
        prop_assert!((measured + forth.normal).norm() < 1e-9);
        let whole = |cloud: &[UncertainPoint], sign: f64| {
            cloud.iter().all(|p| sign * forth.signed_distance(&p.mean) > 0.0)
        };
        prop_assert!(whole(&a, 1.0) && whole(&b, -1.0));
        prop_assert!(forth.normal.dot(&back.normal) < -0.9, "{} {}", forth.normal, back.normal);
    }

    /// κ counts standard deviations, so it goes down as they go up; far points cannot raise it, nor
    /// lower it when they lie behind their own cloud.
    #[test]
    fn a_plane_under_more_noise_and_far_points(seed in 0..10_000_u64, factor in 1.0..10.0_f64) {
        let (samples, _) = cell(Difficulty::Easy, 15, seed);
        let [a, b] = sides(&samples);
        let plane = separate(&a, &b, 50.0).map_err(rejected)?;
        let wider = |cloud: &[UncertainPoint]| -> Vec<UncertainPoint> {
            let grown = |p: &UncertainPoint| p.covariance.scaled(factor);
            cloud.iter().map(|p| UncertainPoint { covariance: grown(p), ..*p }).collect()
        };
        let noisy = separate(&wider(&a), &wider(&b), 50.0).unwrap();
        prop_assert!((noisy.kappa * factor / plane.kappa - 1.0).abs() < 5e-3);
        let mut more = a.clone();
        for k in 0..5 {
            let far = plane.normal * (-100.0 * f64::from(k + 1));
            more.push(UncertainPoint { mean: plane.point + far, ..a[0] });
        }
        let with_far = separate(&more, &b, 50.0).unwrap();
        prop_assert!((with_far.kappa / plane.kappa - 1.0).abs() < 5e-3, "{} {}", with_far.kappa, plane.kappa);
    }
}
