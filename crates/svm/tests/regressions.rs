//! The slips of the first released implementation of the method, one test each.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use crate::support::{Difficulty, Scene, Shape, Stream, cell, settings};
use cloudtouch_geom::{Covariance, Point3, UncertainPoint, Vector3, normal};
use cloudtouch_svm::{
    Class, Classifier, ClassifierError, Kernel, Problem, Rung, Sample, Settings, Status,
    Undetermined, UnitBox,
};

fn sample(x: f64, y: f64, class: Class, covariance: Covariance, radius: f64) -> Sample {
    let point = UncertainPoint { mean: Point3::new(x, y, 0.0), covariance };
    Sample { point, class, radius, penalty: 1e4 }
}

fn tight() -> Settings {
    settings(1e-8)
}

fn classifier(samples: &[Sample], kernel: Kernel) -> Classifier {
    let problem = Problem::new(samples, kernel).unwrap();
    let solution = problem.solve(&tight()).unwrap();
    assert_eq!(solution.status, Status::Converged);
    Classifier::new(&problem, &solution).unwrap()
}

#[test]
fn a_plain_svm_was_trained_instead_of_a_robust_one() {
    // The ellipsoid of A ends at x = −0.3: the robust surface lies half-way from there to B.
    let wide = Covariance::isotropic(0.01);
    for (radius, middle) in [(0.0, 0.0), (1.0, 0.05), (2.0, 0.1)] {
        let samples = [
            sample(-0.5, 0.0, Class::A, wide, radius),
            sample(0.5, 0.0, Class::B, Covariance::zero(), radius),
        ];
        let f = classifier(&samples, Kernel::Linear);
        let value = f.value(&Point3::new(middle, 0.0, 0.0));
        assert!(value.abs() < 1e-4, "radius {radius}: f = {value} at {middle}");
    }
    let (samples, gamma) = cell(Difficulty::Contact, 15, 3);
    let plain: Vec<Sample> = samples.iter().map(|s| Sample { radius: 0.0, ..*s }).collect();
    let solve = |samples: &[Sample]| {
        Problem::new(samples, Kernel::Gaussian { gamma }).unwrap().solve(&tight()).unwrap()
    };
    assert!(solve(&samples).primal > 1.01 * solve(&plain).primal);
    assert!(solve(&samples).v.iter().any(|v| v.norm() > 1e-3));
}

#[test]
fn covariances_were_left_unscaled_while_coordinates_were_scaled() {
    let (samples, gamma) = cell(Difficulty::Easy, 15, 1);
    let solve_in_box = |samples: &[Sample]| {
        let unit_box = UnitBox::around(samples.iter().map(|s| &s.point)).unwrap();
        let inside: Vec<Sample> = samples.iter().map(|s| unit_box.sample_inside(s)).collect();
        classifier(&inside, Kernel::Gaussian { gamma }).outside(unit_box)
    };
    let reference = solve_in_box(&samples);
    for scale in [1e-3, 250.0] {
        let scaled: Vec<Sample> = samples
            .iter()
            .map(|s| {
                let mean = Point3::from(s.point.mean.coords * scale);
                let covariance = s.point.covariance.scaled(scale);
                Sample { point: UncertainPoint { mean, covariance }, ..*s }
            })
            .collect();
        let f = solve_in_box(&scaled);
        for (small, large) in samples.iter().zip(&scaled) {
            let p = reference.probability(&small.point, small.class).unwrap();
            let q = f.probability(&large.point, large.class).unwrap();
            assert!((p - q).abs() < 1e-5, "scale {scale}: {p} {q}");
        }
    }
}

#[test]
fn the_maximum_over_partial_gradient_sums_was_taken() {
    // Many terms of both signs: every partial sum is far from the whole.
    let (samples, gamma) = cell(Difficulty::Contact, 25, 5);
    let f = classifier(&samples, Kernel::Gaussian { gamma });
    assert!(f.term_count() > 5);
    for s in &samples {
        let at = s.point.mean;
        let (value, _) = f.value_and_gradient(&at);
        let slope = Vector3::from_fn(|axis, _| {
            let mut step = Vector3::zeros();
            step[axis] = 1e-5;
            (f.value(&(at + step)) - f.value(&(at - step))) / 2e-5
        });
        let std = (s.point.covariance.sqrt() * slope).norm();
        let expected = normal::cdf(-s.class.sign() * value / std);
        let got = f.probability(&s.point, s.class).unwrap();
        assert!((got - expected).abs() < 1e-6, "{got} {expected}");
    }
}

#[test]
fn nan_ended_as_probability_zero() {
    let (samples, gamma) = cell(Difficulty::Easy, 10, 2);
    let f = classifier(&samples, Kernel::Gaussian { gamma });
    let good = samples[0].point;
    assert!(f.probability(&good, Class::A).is_some());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mean = Point3::new(0.0, bad, 0.0);
        assert_eq!(f.probability(&UncertainPoint { mean, ..good }, Class::A), None);
        assert_eq!(f.probability(&UncertainPoint::exact(mean), Class::B), None);
        let covariance = Covariance::isotropic(bad.abs()).sum(&Covariance::diagonal([bad; 3]));
        if !covariance.is_finite() {
            assert_eq!(f.probability(&UncertainPoint { covariance, ..good }, Class::A), None);
        }
    }
    // A solve that has not come near the optimum gives no classifier at all.
    let problem = Problem::new(&samples, Kernel::Gaussian { gamma }).unwrap();
    let unfinished =
        problem.solve(&Settings { max_steps: Some(1), fallback: false, ..tight() }).unwrap();
    assert_eq!(unfinished.status, Status::StepLimit);
    assert!(matches!(
        Classifier::new(&problem, &unfinished),
        Err(ClassifierError::Undetermined(Undetermined::Gap { status: Status::StepLimit, .. }))
    ));
}

/// Points of A that cross a densely sampled exact surface, as of a mesh that is trusted.
fn through_a_mesh(per_mesh: usize, penalty: f64) -> Vec<Sample> {
    let scene = Scene {
        shape: Shape::CrossingSheet,
        count_a: 20,
        count_b: per_mesh,
        gap: -0.2,
        noise: 0.03,
        anisotropic: false,
        radius: 1.0,
        penalty,
    };
    let mut samples = scene.samples(&mut Stream::new(11));
    for sample in samples.iter_mut().filter(|s| s.class == Class::B) {
        sample.point = UncertainPoint::exact(sample.point.mean);
    }
    samples
}

#[test]
fn the_interior_point_method_crept_up_to_large_penalties() {
    let problem =
        Problem::new(&through_a_mesh(600, 1e7), Kernel::Gaussian { gamma: 27.0 }).unwrap();
    let solution = problem.solve(&Settings::default()).unwrap();
    assert_eq!((solution.status, solution.rung), (Status::Converged, Rung::InteriorPoint));
    assert_eq!(solution.effort.clarabel_iterations, 0);
    // From a start of 10 it takes 22.
    assert!(solution.effort.interior_iterations <= 20, "{:?}", solution.effort);
}

#[test]
fn a_large_problem_was_worked_on_for_minutes() {
    // Beyond what is worth a dense matrix, and far from what SMO can finish.
    let problem =
        Problem::new(&through_a_mesh(1800, 1e7), Kernel::Gaussian { gamma: 5.0 }).unwrap();
    let solution = problem.solve(&tight()).unwrap();
    assert_eq!(solution.status, Status::TooLarge);
    let effort = solution.effort;
    assert_eq!((effort.interior_iterations, effort.clarabel_iterations), (0, 0));
    assert!(effort.smo_steps * problem.len() <= 300_000_000, "{effort:?}");
}
