//! The catalogue is well formed and its claims are true.

use std::collections::BTreeSet;

use cloudtouch_geom::Covariance;
use cloudtouch_testkit::{
    brute,
    exact::brute::point_distance,
    hard_cases::{hard_cases, hard_meshes, hard_problems},
};

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
fn names_of_the_other_lists_are_unique_too() {
    fn check<'a>(names: impl Iterator<Item = &'a str>) {
        let names: Vec<_> = names.collect();
        let unique: BTreeSet<_> = names.iter().collect();
        assert_eq!(unique.len(), names.len(), "{names:?}");
    }
    check(hard_problems().iter().map(|p| p.name));
    check(hard_meshes().iter().map(|m| m.name));
}

#[test]
fn problems_have_a_radius_for_each_point_and_settings_that_are_allowed() {
    for problem in hard_problems() {
        assert_eq!(problem.points_a.len(), problem.radii_a.len(), "{}", problem.name);
        assert_eq!(problem.points_b.len(), problem.radii_b.len(), "{}", problem.name);
        assert!(problem.penalty > 0.0 && problem.gamma > 0.0, "{}", problem.name);
    }
    let radii = hard_problems()[0].radii_a.clone();
    assert!(radii.contains(&0.0) && radii.contains(&6.0));
}

#[test]
fn meshes_have_a_surface_where_they_are_said_to_and_free_clouds_keep_away() {
    for case in hard_meshes() {
        assert_eq!(case.mesh.merged().triangles().is_empty(), !case.valid, "{}", case.name);
        if case.valid && !case.collides {
            let distances = case.cloud.iter().map(|p| point_distance(&case.mesh, p));
            let nearest = distances.fold(f64::INFINITY, f64::min);
            assert!(nearest >= 4.9 * case.std, "{}: {nearest} m", case.name);
        }
    }
}

#[test]
fn the_catalogue_does_not_change_between_calls() {
    // NaN differs from itself, so compare what is printed.
    let text = |i: usize| format!("{:?}", &hard_cases()[i]);
    for i in [0, 9, 20, 30] {
        assert_eq!(text(i), text(i));
    }
}
