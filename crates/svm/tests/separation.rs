//! The linear certificate: its κ always holds, and is near the best there is.

use crate::support::Stream;
use cloudtouch_geom::{Covariance, Point3, UncertainPoint, UnitVector3, Vector3, normal};
use cloudtouch_svm::{Class, DEFAULT_KAPPA_MAX, NoSeparation, separate};

fn clouds(stream: &mut Stream, apart: f64) -> [Vec<UncertainPoint>; 2] {
    let mut cloud = |offset: f64, count: usize| {
        (0..count)
            .map(|_| {
                let mean = Point3::new(
                    stream.range(-0.5, 0.5),
                    stream.range(-0.5, 0.5),
                    stream.range(0.0, 0.3),
                );
                let axis = UnitVector3::new_normalize(stream.normal_vector());
                let along = stream.log_range(1e-3, 0.1);
                let covariance = match stream.below(3) {
                    0 => Covariance::zero(),
                    1 => Covariance::isotropic(along * along),
                    _ => Covariance::from_axis(&axis, along, along * 0.1),
                };
                UncertainPoint { mean: mean + Vector3::z() * offset, covariance }
            })
            .collect::<Vec<_>>()
    };
    [cloud(0.3 + apart, 15), cloud(0.0, 15)]
}

/// The best κ of all planes across a direction from B to A, by bisection.
fn kappa_across(a: &[UncertainPoint], b: &[UncertainPoint], n: &Vector3) -> f64 {
    let width = |kappa: f64| {
        let low = |cloud: &[UncertainPoint], n: &Vector3| {
            cloud
                .iter()
                .map(|p| n.dot(&p.mean.coords) - kappa * p.covariance.std_along(n))
                .fold(f64::INFINITY, f64::min)
        };
        low(a, n) + low(b, &-n)
    };
    if width(0.0) <= 0.0 {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 100.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if width(middle) >= 0.0 { low = middle } else { high = middle }
    }
    low
}

/// Random search with shrinking steps over directions: slow, and unlike the method under test.
fn best_kappa(stream: &mut Stream, a: &[UncertainPoint], b: &[UncertainPoint]) -> f64 {
    let mut best = (Vector3::z(), kappa_across(a, b, &Vector3::z()));
    for round in 0..1500 {
        let step = 0.5 * 0.99_f64.powi(round);
        let n = (best.0 + stream.normal_vector() * step).normalize();
        let kappa = kappa_across(a, b, &n);
        if kappa > best.1 {
            best = (n, kappa);
        }
    }
    best.1
}

#[test]
fn kappa_holds_for_every_point_and_is_near_the_best() {
    let mut stream = Stream::new(11);
    let (mut found, mut capped) = (0, 0);
    for case in 0..120 {
        let apart = stream.range(-0.2, 0.5);
        let [a, b] = clouds(&mut stream, apart);
        // Without a cap the best value itself is compared, with the usual one its truncation.
        let cap = if case % 2 == 0 { 50.0 } else { DEFAULT_KAPPA_MAX };
        let reference = best_kappa(&mut stream, &a, &b).min(cap);
        let Ok(plane) = separate(&a, &b, cap) else {
            assert!(reference < 1e-3, "case {case}: missed a plane with kappa {reference}");
            continue;
        };
        found += 1;
        capped += usize::from(plane.kappa == cap);
        assert!((plane.normal.norm() - 1.0).abs() < 1e-12);
        for (cloud, sign) in [(&a, 1.0), (&b, -1.0)] {
            for p in cloud {
                let margin = sign * plane.signed_distance(&p.mean);
                assert!(margin > 0.0);
                assert!(margin >= plane.kappa * p.covariance.std_along(&plane.normal));
                let probability = normal::below_zero(margin, p.covariance.std_along(&plane.normal));
                assert!(probability <= plane.point_probability_bound() * (1.0 + 1e-6));
            }
        }
        assert!(plane.kappa >= 0.995 * reference, "case {case}: {} of {reference}", plane.kappa);
    }
    assert!(found > 40 && capped > 10, "{found} found, {capped} capped");
}

#[test]
fn a_plane_without_a_limit_was_half_as_good() {
    let cloud = |height: f64, unit: f64| {
        let point = |i: u32| UncertainPoint {
            mean: Point3::new(f64::from(i % 5), f64::from(i / 5), height) * (0.1 * unit),
            covariance: Covariance::isotropic((0.01 * unit).powi(2)),
        };
        (0..20).map(point).collect::<Vec<_>>()
    };
    for unit in [1.0, 1e6] {
        let (a, b) = (cloud(5.0, unit), cloud(0.0, unit));
        let limited = separate(&a, &b, 1e3).expect("half a length apart").kappa;
        for limit in [1e9, 1e17, 1e20, 1e300, f64::MAX] {
            let found = separate(&a, &b, limit).map(|plane| plane.kappa);
            assert!(
                found.is_ok_and(|kappa| (kappa / limited - 1.0).abs() < 1e-6),
                "{found:?} up to {limit:e}, {limited} up to 1e3"
            );
        }
        // Exact points have no best κ.
        let exact = |of: &[UncertainPoint]| {
            of.iter().map(|p| UncertainPoint::exact(p.mean)).collect::<Vec<_>>()
        };
        let plane = separate(&exact(&a), &exact(&b), 1e20).expect("half a length apart");
        assert_eq!(plane.kappa, 1e20);
    }
}

#[test]
fn translation_far_away_and_scale_change_nothing() {
    let mut stream = Stream::new(5);
    for _ in 0..20 {
        let [a, b] = clouds(&mut stream, 0.2);
        let near = separate(&a, &b, 50.0).map_or(0.0, |s| s.kappa);
        let offset = Vector3::new(5e6, -5e6, 1e3);
        for (scale, offset) in [(1e3, offset * 1e3), (1e-6, Vector3::zeros()), (1.0, offset)] {
            let map = |cloud: &[UncertainPoint]| -> Vec<UncertainPoint> {
                cloud
                    .iter()
                    .map(|p| UncertainPoint {
                        mean: p.mean * scale + offset,
                        covariance: p.covariance.scaled(scale),
                    })
                    .collect()
            };
            let far = separate(&map(&a), &map(&b), 50.0).map_or(0.0, |s| s.kappa);
            // Coordinates near 5e6 are themselves rounded to 1e-9.
            assert!((far - near).abs() < 1e-4 * (1.0 + near), "{far} {near}");
        }
    }
}

/// Where coordinates are a tenth of a millimetre apart and more, so is the plane itself.
#[test]
fn a_plane_far_from_the_origin_promised_more_than_it_kept() {
    let mut stream = Stream::new(6);
    let mut found = [0; 3];
    for case in 0..40 {
        let [a, b] = clouds(&mut stream, 0.2);
        for (k, far) in [1e9, 1e11, 1e12].into_iter().enumerate() {
            let offset = Vector3::new(0.6, -1.0, 0.8) * far;
            let map = |cloud: &[UncertainPoint]| -> Vec<UncertainPoint> {
                cloud.iter().map(|p| UncertainPoint { mean: p.mean + offset, ..*p }).collect()
            };
            let (a, b) = (map(&a), map(&b));
            let Ok(plane) = separate(&a, &b, 50.0) else { continue };
            found[k] += 1;
            for (cloud, sign) in [(&a, 1.0), (&b, -1.0)] {
                for p in cloud {
                    let margin = sign * plane.signed_distance(&p.mean);
                    let std = p.covariance.std_along(&plane.normal);
                    assert!(margin > 0.0, "case {case} at {far} m: on the wrong side");
                    assert!(
                        margin >= plane.kappa * std,
                        "case {case} at {far} m: {} deviations of {}",
                        margin / std,
                        plane.kappa
                    );
                }
            }
        }
    }
    assert!(found.iter().all(|planes| *planes >= 20), "{found:?} planes");
}

#[test]
fn degenerate_clouds_end_without_a_plane_or_with_an_honest_one() {
    let at = |x: f64| UncertainPoint::exact(Point3::new(x, 0.0, 0.0));
    let none =
        |a: &[UncertainPoint], b: &[UncertainPoint], kappa| separate(a, b, kappa).unwrap_err();
    let empty = |class| NoSeparation::Empty { class };
    let not_finite = |class, index| NoSeparation::NotFinite { class, index };
    assert_eq!(none(&[], &[at(0.0)], 4.75), empty(Class::A));
    assert_eq!(none(&[at(0.0)], &[], 4.75), empty(Class::B));
    assert_eq!(none(&[at(1.0)], &[at(1.0)], 4.75), NoSeparation::WithinRounding);
    assert_eq!(none(&[at(0.0), at(f64::NAN)], &[at(1.0)], 4.75), not_finite(Class::A, 1));
    assert_eq!(none(&[at(0.0)], &[at(f64::INFINITY)], 4.75), not_finite(Class::B, 0));
    for value in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        let error = none(&[at(0.0)], &[at(1.0)], value);
        assert!(matches!(error, NoSeparation::KappaMax { .. }), "{error}");
    }
    // Collinear and interleaved: no plane has all of A on one side.
    assert_eq!(none(&[at(0.0), at(2.0)], &[at(1.0)], 4.75), NoSeparation::NotFound);
    // Exact points are infinitely many standard deviations away: the cap is what is left.
    let plane = separate(&[at(0.0), at(-1.0), at(0.0)], &[at(1.0)], 4.75).unwrap();
    assert_eq!(plane.kappa, 4.75);
    assert!((plane.normal - Vector3::x()).norm() < 1e-12);
    // Ellipsoids of 4.75 standard deviations that just fail to fit.
    let uncertain = |x: f64| UncertainPoint {
        mean: Point3::new(x, 0.0, 0.0),
        covariance: Covariance::isotropic(1.0),
    };
    let plane = separate(&[uncertain(0.0)], &[uncertain(9.0)], 4.75).unwrap();
    assert!((plane.kappa - 4.5).abs() < 1e-9);
}
