//! A six-axis arm written by the test: kinematics and contacts against what is known exactly.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use crate::support::{Arm, STD, joints, query, wall};
use cloudtouch::geom::{Point3, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Verdict};
use cloudtouch_robot::{JointKind, Robot, RobotChecker, Touching};
use proptest::prelude::*;

fn checker(robot: Robot, body: impl Into<Body>, touching: Touching) -> RobotChecker {
    RobotChecker::new(robot, body.into(), Pose::identity(), touching).unwrap()
}

/// The wall as a scan sees it.
fn scan(x: f64) -> Cloud {
    Cloud::prepare(&wall(x), &CloudSettings::new(SensorModel::Isotropic { std: STD })).unwrap()
}

#[test]
fn an_arm_reaches_as_far_as_its_links() {
    let robot = Arm::default().robot();
    let stretched = robot.link_poses(&joints([0.0; 6])).unwrap();
    let tip = Point3::new(0.0, 0.0, Arm::HAND);
    // Straight up: 0.2 m of base and three links.
    let up = stretched["hand"].transform_point(&tip);
    assert!((up - Point3::new(0.0, 0.0, Arm::TOP)).norm() < 1e-12, "{up}");
    // The shoulder bent: forwards along x, at the height of the shoulder.
    let bent = robot.link_poses(&joints([0.0, FRAC_PI_2, 0.0, 0.0, 0.0, 0.0])).unwrap();
    let ahead = bent["hand"].transform_point(&tip);
    assert!((ahead - Point3::new(Arm::TOP - 0.2, 0.0, 0.2)).norm() < 1e-12, "{ahead}");
    // Turned by the waist it points along y.
    let turned = robot.link_poses(&joints([FRAC_PI_2, FRAC_PI_2, 0.0, 0.0, 0.0, 0.0])).unwrap();
    let aside = turned["hand"].transform_point(&tip);
    assert!((aside - Point3::new(0.0, Arm::TOP - 0.2, 0.2)).norm() < 1e-12, "{aside}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 64, ..ProptestConfig::default() })]

    /// Against rotation matrices written out by hand, link by link.
    #[test]
    fn poses_are_products_of_matrices(angles in prop::array::uniform6(-1.9..1.9_f64)) {
        let robot = Arm::default().robot();
        let poses = robot.link_poses(&joints(angles)).unwrap();
        let mut at = nalgebra::Matrix4::<f64>::identity();
        for ((name, axis, height), angle) in Arm::JOINTS.into_iter().zip(angles) {
            let (sin, cos) = angle.sin_cos();
            let turn = match axis {
                'z' => nalgebra::matrix![cos, -sin, 0.0; sin, cos, 0.0; 0.0, 0.0, 1.0],
                _ => nalgebra::matrix![cos, 0.0, sin; 0.0, 1.0, 0.0; -sin, 0.0, cos],
            };
            let mut step = turn.to_homogeneous();
            step[(2, 3)] = height;
            at *= step;
            let found = poses[name].isometry().to_homogeneous();
            prop_assert!((found - at).amax() < 1e-12, "{}", name);
        }
    }
}

/// What is drawn of a robot is what was asked about.
#[test]
fn the_robot_in_its_surroundings_is_a_scene_that_answers_alike() {
    let checker = checker(Arm::default().robot(), scan(Arm::TOP - 0.21), Touching::Surroundings);
    let at = joints([0.0, FRAC_PI_2, 0.0, 0.0, 0.0, 0.0]);
    let scene = checker.scene_at(&at).unwrap();
    let answers = [scene.check(&query()), checker.check(&query(), &at).unwrap()];
    let [of_scene, of_robot] = answers.map(|checked| {
        let [pair] = <[_; 1]>::try_from(checked.pairs).unwrap();
        let report = pair.answer.unwrap();
        (pair.a, pair.b, report.collision_probability.to_bits(), report.contacts)
    });
    assert_eq!(of_scene, of_robot);
    let hand = checker.robot().link_poses(&at).unwrap()["hand"];
    assert_eq!(scene.pose("hand").unwrap(), hand);
}

/// The hand ends at a known place; the wall is put before, at and behind it.
#[test]
fn the_hand_and_no_other_link_meets_a_wall_where_it_should() {
    let robot = Arm::default().robot();
    let forwards = joints([0.0, FRAC_PI_2, 0.0, 0.0, 0.0, 0.0]);
    let tip = Arm::TOP - 0.2;
    for (beyond, verdict) in [(10.0 * STD, Verdict::Free), (-8.0 * STD, Verdict::InCollision)] {
        let checker = checker(robot.clone(), scan(tip + beyond), Touching::Surroundings);
        let found = checker.check(&query(), &forwards).unwrap();
        assert_eq!(found.verdict(), verdict, "{beyond}: {:?}", found.pairs);
        if verdict == Verdict::Free {
            continue;
        }
        let names: Vec<[&str; 2]> =
            found.pairs.iter().map(|pair| [pair.a.as_str(), pair.b.as_str()]).collect();
        assert_eq!(names, [["surroundings", "hand"]]);
        let report = found.pairs[0].answer.as_ref().unwrap();
        let contact = &report.contacts[0].point;
        assert!((contact.x - tip).abs() < 0.02 && (contact.z - 0.2).abs() < 0.06, "{contact}");
    }
}

/// The same, seen from a camera somewhere: the base is placed in its frame.
#[test]
fn the_base_may_be_anywhere() {
    let cloud_from_base =
        Pose::from_translation_rpy(Vector3::new(0.4, -1.0, 2.0), [2.0, 0.3, -1.0]);
    let tip = Arm::TOP - 0.2;
    let mut seen = wall(tip - 8.0 * STD);
    seen.points.iter_mut().for_each(|p| *p = cloud_from_base.transform_point(p));
    let settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
    let cloud = Body::from(Cloud::prepare(&seen, &settings).unwrap());
    let robot = Arm::default().robot();
    let checker = RobotChecker::new(robot, cloud, cloud_from_base, Touching::Surroundings).unwrap();
    let forwards = joints([0.0, FRAC_PI_2, 0.0, 0.0, 0.0, 0.0]);
    let found = checker.check(&query(), &forwards).unwrap();
    assert_eq!(found.verdict(), Verdict::InCollision);
    let point = found.pairs[0].answer.as_ref().unwrap().contacts[0].point;
    let in_base = cloud_from_base.inverse().transform_point(&point);
    assert!((in_base.x - tip).abs() < 0.02, "{in_base}");
    assert_eq!(checker.check(&query(), &joints([0.0; 6])).unwrap().verdict(), Verdict::Free);
}

#[test]
fn the_next_scan_takes_the_place_of_the_last() {
    let forwards = joints([0.0, FRAC_PI_2, 0.0, 0.0, 0.0, 0.0]);
    let mut checker = checker(Arm::default().robot(), scan(Arm::TOP), Touching::Surroundings);
    let verdict = |checker: &RobotChecker| checker.check(&query(), &forwards).unwrap().verdict();
    assert_eq!(verdict(&checker), Verdict::Free);
    let last = checker.replace_surroundings(Body::from(scan(Arm::TOP - 0.2 - 8.0 * STD))).unwrap();
    assert_eq!(verdict(&checker), Verdict::InCollision);
    checker.replace_surroundings(last).unwrap();
    assert_eq!(verdict(&checker), Verdict::Free);
}

/// The robot in its own scan: in collision with itself, until it is filtered at the joints of the scan.
#[test]
fn what_is_seen_of_the_robot_is_removed_where_it_was_and_what_is_in_the_way_stays() {
    let robot = Arm::default().robot();
    let at_scan = joints([0.0; 6]);
    let poses = robot.link_poses(&at_scan).unwrap();
    let mut seen = wall(Arm::TOP - 0.2 - 8.0 * STD);
    for (link, radius, length) in Arm::CYLINDERS {
        for k in 0..400 {
            let (angle, height) = (0.7 * f64::from(k), length * f64::from(k) / 400.0);
            let p = Point3::new(radius * angle.cos(), radius * angle.sin(), height);
            seen.points.push(poses[link].transform_point(&p));
        }
    }
    let prepare = |filtered: bool| {
        let mut settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
        if filtered {
            settings.filter.robot = robot.self_filter(&at_scan, &Pose::identity(), 0.01).unwrap();
        }
        Cloud::prepare(&seen, &settings).unwrap()
    };
    let verdict = |cloud: Cloud, joints: &BTreeMap<String, f64>| {
        checker(robot.clone(), cloud, Touching::Surroundings)
            .check(&query(), joints)
            .unwrap()
            .verdict()
    };
    assert_eq!(verdict(prepare(false), &at_scan), Verdict::InCollision);
    assert_eq!(verdict(prepare(true), &at_scan), Verdict::Free);
    let forwards = joints([0.0, FRAC_PI_2, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(verdict(prepare(true), &forwards), Verdict::InCollision);
}

#[test]
fn a_folded_arm_meets_itself_but_for_neighbours_and_pairs_of_the_srdf() {
    let arm = Arm::default();
    let robot = arm.robot();
    assert_eq!(robot.may_touch("upper_arm", "forearm"), Ok(true));
    assert_eq!(robot.may_touch("forearm", "upper_arm"), Ok(true));
    assert_eq!(robot.may_touch("base", "hand"), Ok(false));
    // A slip in a name read as a pair that is asked about.
    for [a, b] in [["base", "Fore_arm"], ["Fore_arm", "base"]] {
        let error = robot.may_touch(a, b).unwrap_err();
        assert!(error.near.starts_with("forearm, "), "{error}");
        assert!(error.to_string().starts_with("the robot has no link `Fore_arm`"), "{error}");
    }
    // The elbow folded back: the forearm passes the upper arm, and the hand, 0.45 m down the forearm
    // and 11 cm behind the axis, ends in the base and nowhere else.
    let folded = joints([0.0, 0.0, 2.9, 0.0, 0.0, 0.0]);
    let far = || scan(5.0);
    let alone =
        checker(robot.clone(), far(), Touching::Surroundings).check(&query(), &folded).unwrap();
    assert_eq!(alone.pairs.len(), 0, "{:?}", alone.pairs);
    let found =
        checker(robot.clone(), far(), Touching::AndItself).check(&query(), &folded).unwrap();
    assert_eq!(found.verdict(), Verdict::InCollision);
    let pairs: Vec<[&str; 2]> =
        found.pairs.iter().map(|pair| [pair.a.as_str(), pair.b.as_str()]).collect();
    assert_eq!(pairs, [["base", "hand"]]);
    let srdf = arm.srdf(&pairs);
    let allowed = robot.with_srdf(srdf).unwrap();
    let checked = checker(allowed, far(), Touching::AndItself).check(&query(), &folded).unwrap();
    assert_eq!((checked.verdict(), checked.pairs.len()), (Verdict::Free, 0));
    let straight = joints([0.0; 6]);
    let checked =
        checker(arm.robot(), far(), Touching::AndItself).check(&query(), &straight).unwrap();
    assert_eq!(checked.verdict(), Verdict::Free, "{:?}", checked.pairs);
}

#[test]
fn joints_know_their_kind_and_limits() {
    let robot = Arm::default().robot();
    let elbow = robot.joints().iter().find(|joint| joint.name == "elbow").unwrap();
    assert_eq!((elbow.kind, elbow.limits), (JointKind::Revolute, Some([-3.0, 3.0])));
    assert_eq!(robot.links().len(), 7);
}
