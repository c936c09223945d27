//! Flat ellipsoids.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use cloudtouch_geom::{Covariance, Point3, UncertainPoint, Vector3};
use cloudtouch_svm::separate;

#[test]
fn a_thin_ellipsoid_read_back_as_exact_along_its_axis() {
    let n = Vector3::new(0.36, 0.48, 0.8);
    let at = |along: f64| UncertainPoint {
        mean: Point3::from(n * along),
        covariance: Covariance::from_axis(&n, 1e-9, 1.0),
    };
    let plane = separate(&[at(3e-9)], &[at(0.0)], 50.0).unwrap();
    println!("{plane:?}");
    assert!(plane.kappa <= 1.5);
}
