//! Flat ellipsoids: the certificate, training and the classifier see the same thickness.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use crate::support::settings;
use cloudtouch_geom::{Covariance, Point3, UncertainPoint, UnitVector3, Vector3, normal};
use cloudtouch_svm::{Class, Classifier, Kernel, Problem, Sample, Status, UnitBox, separate};

/// Discs a metre wide, a nanometre thick and three nanometres apart.
fn discs() -> ([UncertainPoint; 2], UnitVector3) {
    let n = UnitVector3::new_normalize(Vector3::new(0.36, 0.48, 0.8));
    let at = |along: f64| UncertainPoint {
        mean: Point3::from(n.into_inner() * along),
        covariance: Covariance::from_axis(&n, 1e-9, 1.0),
    };
    ([at(1.5e-9), at(-1.5e-9)], n)
}

#[test]
fn a_thin_ellipsoid_read_back_as_exact_along_its_axis() {
    let ([a, b], n) = discs();
    let plane = separate(&[a], &[b], 50.0).unwrap();
    // Both are 1.5 of their standard deviations from the plane between them.
    assert!(plane.kappa <= 1.5 && plane.kappa > 1.499, "{plane:?}");
    assert!((plane.normal + n.into_inner()).norm() < 1e-7);
}

#[test]
fn a_thin_ellipsoid_was_trained_on_as_another_one() {
    let ([a, b], _) = discs();
    for scaled in [false, true] {
        let unit_box = UnitBox::around(&[a, b]).unwrap();
        let place =
            |p: &UncertainPoint| if scaled { unit_box.uncertain_point_inside(p) } else { *p };
        let penalty = if scaled { 1e3 } else { 1e21 };
        let sample = |p, class| Sample { point: place(p), class, radius: 1.0, penalty };
        let samples = [sample(&a, Class::A), sample(&b, Class::B)];
        let problem = Problem::new(&samples, Kernel::Linear).unwrap();
        let solution = problem.solve(&settings(1e-6)).unwrap();
        assert_eq!(solution.status, Status::Converged, "scaled {scaled}");
        let f = Classifier::new(&problem, &solution).unwrap();
        for s in &samples {
            // The margin, f = 1, at one of its standard deviations: f = 3 at 1.5 of them.
            let (value, gradient) = f.value_and_gradient(&s.point.mean);
            assert!((s.class.sign() * value - 3.0).abs() < 1e-2, "{value}");
            assert!((s.point.covariance.std_along(&gradient) - 2.0).abs() < 1e-2);
            let p = f.probability(&s.point, s.class).unwrap();
            assert!((p / normal::cdf(-1.5) - 1.0).abs() < 1e-2, "scaled {scaled}: {p}");
        }
    }
}
