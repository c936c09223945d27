//! Between the positions of a path nothing is missed.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use crate::support::{Arm, STD, joints, query, wall};
use cloudtouch::geom::{PointCloud, Pose};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Verdict};
use cloudtouch_robot::{PathError, RobotChecker, Touching};

const TOLERANCE: f64 = 0.002;

fn among(cloud: &PointCloud, touching: Touching) -> RobotChecker {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
    let body = Body::from(Cloud::prepare(cloud, &settings).unwrap());
    RobotChecker::new(Arm::default().robot(), body, Pose::identity(), touching).unwrap()
}

/// Bent forwards, and turned about the waist.
fn around(waist: f64) -> BTreeMap<String, f64> {
    joints([waist, FRAC_PI_2, 0.0, 0.0, 0.0, 0.0])
}

/// Both ends are free, and the wall is between them: the arm sweeps through it.
#[test]
fn a_wall_between_two_free_positions_is_found_where_the_arm_meets_it() {
    let tip = Arm::TOP - 0.2;
    let checker = among(&wall(0.9 * tip), Touching::Surroundings);
    let path = [around(-1.4), around(1.4)];
    let found = checker.check_path(&query(), &path, TOLERANCE).unwrap();
    assert!(found.given.iter().all(|at| at.verdict() == Verdict::Free));
    // The tip, with the radius of the hand, is at the wall where cos = 0.9 or a little sooner.
    let meets = |share: f64| (2.8 * share - 1.4).cos() * tip + 0.03;
    let until = found.certified_free_until;
    assert!((0.2..0.4).contains(&until) && meets(until) < 0.9 * tip + 0.05, "{until}");
    let stopped = found.stopped.as_ref().unwrap();
    assert!(stopped.segment == 0 && stopped.t >= until, "{stopped:?}");
    // It read undecided, for nothing was known beyond.
    assert_eq!(found.verdict(), Verdict::InCollision);
    let later = found.later.as_ref().unwrap_or(stopped);
    assert_eq!(later.pair.as_ref().unwrap().verdict(), Verdict::InCollision, "{later:?}");
    // Either a pair is named, or that which is nearest.
    assert_ne!(stopped.pair.is_some(), stopped.nearest.is_some(), "{stopped:?}");
    // What is certified is free wherever it is looked at.
    for k in 0..=60 {
        let waist = -1.4 + 2.8 * until * f64::from(k) / 60.0;
        assert_eq!(checker.check(&query(), &around(waist)).unwrap().verdict(), Verdict::Free);
    }
}

#[test]
fn a_path_in_the_open_is_certified_to_its_end() {
    let checker = among(&wall(1.2 * Arm::TOP), Touching::AndItself);
    let path = [around(-1.0), around(0.5), joints([0.0, 0.3, 0.6, 1.0, 0.5, 0.0])];
    let found = checker.check_path(&query(), &path, TOLERANCE).unwrap();
    assert_eq!((found.certified_free_until, found.verdict()), (1.0, Verdict::Free), "{found:?}");
    assert!(found.stopped.is_none() && found.looked_at > 3);
}

#[test]
fn a_position_given_that_is_not_free_ends_the_certificate() {
    let tip = Arm::TOP - 0.2;
    let checker = among(&wall(tip - 0.02), Touching::Surroundings);
    for (path, until) in
        [([around(0.0), around(1.5)], 0.0..=0.0), ([around(1.5), around(0.0)], 0.5..=0.97)]
    {
        let found = checker.check_path(&query(), &path, TOLERANCE).unwrap();
        assert_eq!(found.verdict(), Verdict::InCollision);
        assert!(until.contains(&found.certified_free_until), "{}", found.certified_free_until);
    }
}

#[test]
fn paths_that_are_none_are_refused() {
    let checker = among(&wall(5.0), Touching::Surroundings);
    let check = |path: &[BTreeMap<String, f64>], tolerance| {
        checker.check_path(&query(), path, tolerance).unwrap_err()
    };
    let two = [around(0.0), around(1.0)];
    assert!(matches!(check(&two[..1], TOLERANCE), PathError::TooFew { count: 1 }));
    for bad in [0.0, -1.0, 1.5, f64::NAN] {
        assert!(matches!(check(&two, bad), PathError::Tolerance { .. }), "{bad}");
    }
    assert!(matches!(check(&[around(0.0), around(9.0)], 0.1), PathError::Joints { index: 1, .. }));
}
