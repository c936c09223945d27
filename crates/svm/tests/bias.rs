//! A bias that the problem leaves open.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use crate::support::{objectives, settings};
use cloudtouch_geom::{Covariance, Point3, UncertainPoint};
use cloudtouch_svm::{
    Class, Classifier, ClassifierError, Kernel, Problem, Sample, Settings, Status, Undetermined,
};

fn along_x(xs: &[(f64, Class)], penalty: f64, std: f64) -> Vec<Sample> {
    let covariance = Covariance::isotropic(std * std);
    let point = |x| UncertainPoint { mean: Point3::new(x, 0.0, 0.0), covariance };
    let sample =
        |&(x, class): &(f64, Class)| Sample { point: point(x), class, radius: 1.0, penalty };
    xs.iter().map(sample).collect()
}

/// Small penalties: every multiplier is at its bound, and any b from −0.986 to 0.986 is optimal.
const OPEN: [(f64, Class); 4] =
    [(0.1, Class::A), (5.0, Class::A), (-0.1, Class::B), (-0.2, Class::B)];

#[test]
fn the_middle_of_an_open_bias_was_read_as_the_bias() {
    for std in [0.0, 0.01] {
        for gap in [1e-2, 1e-3, 1e-9] {
            let samples = along_x(&OPEN, 1e-3, std);
            let problem = Problem::new(&samples, Kernel::Linear).unwrap();
            let solution = problem.solve(&settings(gap)).unwrap();
            assert_eq!(solution.status, Status::Converged);
            let [lowest, highest] = solution.bias_interval;
            assert!((lowest + 0.986).abs() < 1e-3 && (highest - 0.986).abs() < 1e-3);
            assert!(solution.bias_spread > 0.9);
            // Without a covariance there is a side and no probability.
            assert!(std == 0.0 || solution.error.probability > 0.9);
            assert!(matches!(
                Classifier::new(&problem, &solution),
                Err(ClassifierError::Undetermined(Undetermined::Bias { .. }))
            ));
        }
    }
}

#[test]
fn every_bias_of_the_interval_is_as_good_as_the_gap_can_tell() {
    for (penalty, gap) in [(1e-3, 1e-3), (0.3, 1e-3), (0.3, 1e-2), (30.0, 1e-2), (30.0, 1e-6)] {
        let samples = along_x(&OPEN, penalty, 0.05);
        let problem = Problem::new(&samples, Kernel::Linear).unwrap();
        let solution = problem.solve(&settings(gap)).unwrap();
        let value = |bias: f64| {
            let centre = problem.centre();
            objectives(&samples, None, &solution.alpha, &solution.v, &centre, bias).0
        };
        let allowed = solution.relative_gap * solution.primal + 1e-12 * solution.primal;
        let [lowest, highest] = solution.bias_interval;
        assert!(lowest <= solution.bias && solution.bias <= highest);
        for bias in [lowest, 0.5 * (lowest + highest), highest] {
            assert!(value(bias) <= value(solution.bias) + allowed, "penalty {penalty}: {bias}");
        }
        let width = (highest - lowest).max(1e-3);
        for bias in [lowest - 0.01 * width, highest + 0.01 * width] {
            assert!(value(bias) > value(solution.bias), "penalty {penalty}: {bias}");
        }
    }
}

#[test]
fn a_free_multiplier_determines_the_bias() {
    let problem = Problem::new(&along_x(&OPEN, 1e3, 0.01), Kernel::Linear).unwrap();
    let solution = problem.solve(&Settings::default()).unwrap();
    let [lowest, highest] = solution.bias_interval;
    assert!(highest - lowest < 1e-2, "{lowest} {highest}");
    let f = Classifier::new(&problem, &solution).unwrap();
    assert_eq!((f.bias(), f.centre()), (solution.bias, problem.centre()));
    // The bias is f at the centre, where the linear kernel adds nothing.
    assert_eq!(f.value(&f.centre()), f.bias());
}
