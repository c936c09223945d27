//! A converged solution satisfies the optimality conditions, and its function is what it claims.

use crate::support::{Difficulty, cell, middle, settings};
use cloudtouch_geom::{Covariance, Point3, UncertainPoint, Vector3, normal};
use cloudtouch_svm::{Class, Classifier, Kernel, Problem, Sample, Settings, Status};

fn kernels(gamma: f64) -> [Kernel; 2] {
    [Kernel::Linear, Kernel::Gaussian { gamma }]
}

#[test]
fn optimality_conditions_hold() {
    let mut checked = 0;
    for seed in 0..30 {
        let (samples, gamma) = cell(
            [Difficulty::Easy, Difficulty::Contact, Difficulty::Hard][seed % 3],
            15,
            seed as u64,
        );
        for kernel in kernels(gamma) {
            let problem = Problem::new(&samples, kernel).unwrap();
            let solution = problem.solve(&settings(1e-9)).unwrap();
            if solution.status != Status::Converged {
                continue;
            }
            let f = Classifier::new(&problem, &solution).unwrap();
            let scale = solution.squared_norm.sqrt().max(1.0);
            let balance: f64 =
                samples.iter().zip(&solution.alpha).map(|(s, a)| s.class.sign() * a).sum();
            assert!(balance.abs() <= 1e-9 * solution.alpha.iter().sum::<f64>());
            for (sample, (&alpha, v)) in samples.iter().zip(solution.alpha.iter().zip(&solution.v))
            {
                assert!((0.0..=sample.penalty).contains(&alpha));
                assert!(v.norm() <= sample.radius * alpha * (1.0 + 1e-9));
                let (value, gradient) = f.value_and_gradient(&sample.point.mean);
                let g = sample.point.covariance.sqrt() * gradient;
                let reach = sample.radius * g.norm();
                // y − cb: positive for a point whose ellipsoid violates the margin. A multiplier
                // well inside its range must have a violation near 0; the tolerance is what a
                // relative gap of 1e-9 leaves for a multiplier 1 % away from its bounds.
                let excess = 1.0 - sample.class.sign() * value + reach;
                let tolerance = 1e-3 * scale;
                if alpha < 0.99 * sample.penalty {
                    assert!(
                        excess <= tolerance,
                        "seed {seed} {kernel:?}: excess {excess} of {scale}"
                    );
                }
                if alpha > 0.01 * sample.penalty {
                    assert!(
                        excess >= -tolerance,
                        "seed {seed} {kernel:?}: excess {excess} of {scale}"
                    );
                    // The cone vector points against the gradient: v·g = −r α |g|.
                    let off = v.dot(&g) + alpha * reach;
                    assert!(
                        off <= 1e-8 * solution.primal + 1e-12,
                        "seed {seed} {kernel:?}: off {off}"
                    );
                }
            }
            checked += 1;
        }
    }
    assert!(checked >= 40, "{checked} converged");
}

#[test]
fn the_gradient_is_the_derivative_of_the_value() {
    for seed in 0..10 {
        let (samples, gamma) = cell(Difficulty::Contact, 15, seed);
        for kernel in kernels(gamma) {
            let problem = Problem::new(&samples, kernel).unwrap();
            let solution = problem.solve(&Settings::default()).unwrap();
            let f = Classifier::new(&problem, &solution).unwrap();
            for s in &samples {
                let at = s.point.mean + Vector3::new(0.01, -0.02, 0.03);
                let (_, gradient) = f.value_and_gradient(&at);
                for axis in 0..3 {
                    let mut step = Vector3::zeros();
                    step[axis] = 1e-5;
                    let slope = (f.value(&(at + step)) - f.value(&(at - step))) / 2e-5;
                    // Central differences: h²·f''' and rounding of f over h.
                    let tolerance = 1e-6 * (1.0 + gradient.norm()) * gamma.max(1.0);
                    assert!(
                        (gradient[axis] - slope).abs() < tolerance,
                        "{} {slope}",
                        gradient[axis]
                    );
                }
            }
        }
    }
}

#[test]
fn all_radii_zero_is_the_plain_svm() {
    for seed in 0..5 {
        let (samples, gamma) = cell(Difficulty::Contact, 15, seed);
        for kernel in kernels(gamma) {
            let exact: Vec<Sample> = samples.iter().map(|s| Sample { radius: 0.0, ..*s }).collect();
            let no_covariance: Vec<Sample> = samples
                .iter()
                .map(|s| Sample { point: UncertainPoint::exact(s.point.mean), ..*s })
                .collect();
            let settings = settings(1e-8);
            let first = Problem::new(&exact, kernel).unwrap().solve(&settings).unwrap();
            let second = Problem::new(&no_covariance, kernel).unwrap().solve(&settings).unwrap();
            assert!(first.v.iter().all(|v| *v == Vector3::zeros()));
            assert_eq!(first.alpha, second.alpha);
            // The textbook dual: Σα − ½ Σ c_i c_j α_i α_j k(x_i, x_j).
            let centre = middle(&exact);
            let mut dual: f64 = first.alpha.iter().sum();
            for (a, alpha_a) in exact.iter().zip(&first.alpha) {
                for (b, alpha_b) in exact.iter().zip(&first.alpha) {
                    let (x, y) = (a.point.mean - centre, b.point.mean - centre);
                    let k = match kernel {
                        Kernel::Linear => x.dot(&y),
                        Kernel::Gaussian { gamma } => (-gamma * (x - y).norm_squared()).exp(),
                    };
                    dual -= 0.5 * a.class.sign() * b.class.sign() * alpha_a * alpha_b * k;
                }
            }
            assert!((dual - first.dual).abs() < 1e-8 * first.primal);
        }
    }
}

#[test]
fn probabilities_are_the_normal_law_of_the_linearised_function() {
    // One point a side and a plane: f = −2x between x = −0.5 (A) and x = 0.5 (B).
    let at = |x: f64, class: Class| Sample {
        point: UncertainPoint::exact(Point3::new(x, 0.0, 0.0)),
        class,
        radius: 0.0,
        penalty: 100.0,
    };
    let problem = Problem::new(&[at(-0.5, Class::A), at(0.5, Class::B)], Kernel::Linear).unwrap();
    let solution = problem.solve(&settings(1e-9)).unwrap();
    let f = Classifier::new(&problem, &solution).unwrap();
    let uncertain = |x: f64| UncertainPoint {
        mean: Point3::new(x, 0.3, -0.2),
        covariance: Covariance::diagonal([0.01, 1.0, 1.0]),
    };
    for (x, z) in [(-0.5, -5.0), (-1.2, -12.0), (0.05, 0.5)] {
        let p = f.probability(&uncertain(x), Class::A).unwrap();
        // Relative accuracy, far into the tail; z itself carries the solver's 1e-9.
        assert!((p / normal::cdf(z) - 1.0).abs() < 1e-5, "{p} at {x}");
        let q = f.probability(&uncertain(-x), Class::B).unwrap();
        assert!((q / p - 1.0).abs() < 1e-5);
    }
    // Exact points, and a covariance that only varies along the surface: the step function.
    let flat = |x: f64| UncertainPoint {
        mean: Point3::new(x, 0.0, 0.0),
        covariance: Covariance::diagonal([0.0, 1.0, 1.0]),
    };
    assert_eq!(
        f.probability(&UncertainPoint::exact(Point3::new(-0.1, 0.0, 0.0)), Class::A),
        Some(0.0)
    );
    assert_eq!(
        f.probability(&UncertainPoint::exact(Point3::new(0.1, 0.0, 0.0)), Class::A),
        Some(1.0)
    );
    assert_eq!(f.probability(&UncertainPoint::exact(Point3::origin()), Class::A), Some(0.5));
    assert_eq!(f.probability(&flat(-0.1), Class::A), Some(0.0));
    assert_eq!(f.probability(&flat(0.1), Class::A), Some(1.0));
}
