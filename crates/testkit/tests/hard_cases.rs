//! The catalogue is well formed and its claims are true.

use std::collections::BTreeSet;

use cloudtouch_geom::Covariance;
use cloudtouch_testkit::{brute, hard_cases::hard_cases};

#[test]
fn names_are_unique_and_every_point_has_a_matrix() {
    let cases = hard_cases();
    let names: BTreeSet<_> = cases.iter().map(|c| c.name).collect();
    assert_eq!(names.len(), cases.len());
    for case in &cases {
        assert_eq!(case.cloud_a.len(), case.covariance_a.len(), "{}", case.name);
        assert_eq!(case.cloud_b.len(), case.covariance_b.len(), "{}", case.name);
        assert!(!case.reason.is_empty());
    }
}

#[test]
fn valid_cases_have_valid_numbers_only_and_invalid_ones_do_not() {
    for case in hard_cases() {
        let points_ok =
            case.cloud_a.iter().chain(&case.cloud_b).all(|p| p.iter().all(|v| v.is_finite()));
        let matrices_ok = case
            .covariance_a
            .iter()
            .chain(&case.covariance_b)
            .all(|m| Covariance::try_from_matrix(m).is_ok());
        assert_eq!(case.valid, points_ok && matrices_ok, "{}", case.name);
    }
}

#[test]
fn free_cases_keep_a_clearance_of_many_deviations() {
    let mut free = 0;
    for case in hard_cases() {
        // Every pair is tried: leave the one with 100,000 points to its construction.
        if case.collides != Some(false) || !case.valid || case.cloud_b.len() > 10_000 {
            continue;
        }
        let std = case
            .covariance_a
            .iter()
            .chain(&case.covariance_b)
            .map(|m| Covariance::from_symmetric(m).max_std())
            .fold(0.0, f64::max);
        let distance = brute::minimum_distance(&case.cloud_a, &case.cloud_b);
        assert!(distance >= 4.9 * std, "{}: {distance} m with noise {std} m", case.name);
        free += 1;
    }
    assert!(free > 10);
}

#[test]
fn the_catalogue_does_not_change_between_calls() {
    // NaN differs from itself, so compare what is printed.
    let text = |i: usize| format!("{:?}", &hard_cases()[i]);
    for i in [0, 9, 20, 30] {
        assert_eq!(text(i), text(i));
    }
}
