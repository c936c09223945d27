//! Between the positions of a path nothing is missed.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use crate::support::{Arm, STD, joints, query, wall};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Mesh, Verdict};
use cloudtouch_robot::{PathError, RobotChecker, SURROUNDINGS, Touching};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

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

/// Of two small links far apart every position read free, and no path was certified: their distance, or that the
/// second was so much larger, was doubted as that of an object and its scene.
#[test]
fn small_links_far_from_others_or_beside_large_ones_keep_no_path_from_being_free() {
    let small = |name: &str, size: f64, on: &str, z: f64| {
        format!(
            "<link name='{name}'><collision><geometry><box size='{size} {size} {size}'/></geometry></collision>\
             </link><joint name='to_{name}' type='fixed'><parent link='{on}'/><child link='{name}'/>\
             <origin xyz='0 0 {z}'/></joint>\n"
        )
    };
    let head = "<robot name='arm'>\n";
    let imu = small("imu", 0.01, "base", -0.1);
    for (name, size) in [("camera", 0.01), ("frame", 0.001)] {
        let seen = small(name, size, "hand", 0.17);
        let urdf = Arm::urdf().replacen(head, &format!("{head}{imu}{seen}"), 1);
        let settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
        let body = Body::from(Cloud::prepare(&wall(1.2 * Arm::TOP), &settings).unwrap());
        let robot = Arm::default().of(&urdf).unwrap();
        let mut checker =
            RobotChecker::new(robot, body, Pose::identity(), Touching::AndItself).unwrap();
        // What is smaller than the wall is known is doubted beside it rightly.
        checker.allow(name, SURROUNDINGS).unwrap();
        let path = [around(-1.0), around(0.5)];
        let found = checker.check_path(&query(), &path, TOLERANCE).unwrap();
        assert!(found.given.iter().all(|at| at.verdict() == Verdict::Free), "{:?}", found.given);
        assert_eq!(found.verdict(), Verdict::Free, "{:?}", found.stopped);
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
    // Of 1e-9, a path that is barely free was cut into pieces without end.
    for bad in [0.0, -1.0, 1e-9, 1.5, f64::NAN] {
        assert!(matches!(check(&two, bad), PathError::Tolerance { .. }), "{bad}");
    }
    // People count from 1, indexes from 0.
    let error = check(&[around(0.0), around(9.0)], 0.1);
    assert!(error.to_string().starts_with("position 2 of the path: joint `"), "{error}");
    assert!(matches!(error, PathError::Joints { index: 1, .. }), "{error:?}");
}

/// A camera 3.5 m over the arm, with a plate before it that hides what is 80 cm in front of the arm.
fn seen_past_a_plate() -> PointCloud {
    let down = Pose::from_translation_rpy(Vector3::new(0.0, 0.0, 3.5), [PI, 0.0, 0.0]);
    let at = |x: f64, z: f64| Pose::from_translation(Vector3::new(x, 0.0, z));
    let part = |mesh: &TriangleMesh, pose: &Pose| ExactMesh::new(&scene::moved(mesh, pose));
    let plate = part(&scene::cuboid([0.1, 0.1, 0.01]), &at(0.242, 2.5));
    let floor = part(&scene::plane_patch(8.0), &at(0.0, -1.5));
    let camera =
        DepthCamera { depth_std_growth: 2e-4, veil_probability: 0.0, ..DepthCamera::default() };
    PointCloud {
        sensor_pose: Some(down),
        ..camera.scan(&[&plate, &floor], &down, 5).transformed(&down)
    }
}

/// Only the middle of a stretch was asked about what the camera did not see.
#[test]
fn a_path_through_what_the_camera_did_not_see_was_certified() {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.006 });
    let body = Body::from(Cloud::prepare(&seen_past_a_plate(), &settings).unwrap());
    let checker =
        RobotChecker::new(Arm::default().robot(), body, Pose::identity(), Touching::Surroundings)
            .unwrap();
    let verdict = |waist| {
        let verdict = checker.check(&query(), &around(waist)).unwrap().verdict();
        let is_free = checker.is_free(&query(), &around(waist)).unwrap();
        assert_eq!(is_free, verdict == Verdict::Free, "{waist}");
        verdict
    };
    let expected = [Verdict::Free, Verdict::Free, Verdict::Undecided, Verdict::Free];
    assert_eq!([-1.2, -0.35, 0.0, 0.5].map(verdict), expected);
    let path = [around(-1.2), around(0.5)];
    let found = checker.check_path(&query(), &path, TOLERANCE).unwrap();
    let until = found.certified_free_until;
    assert!(found.verdict() == Verdict::Undecided && (0.4..0.7).contains(&until), "{found:?}");
}

/// A turn of the waist moves no link that it carries against another.
#[test]
fn links_that_turn_together_were_taken_to_turn_against_each_other() {
    let checker = among(&wall(3.0 * Arm::TOP), Touching::AndItself);
    let found = checker.check_path(&query(), &[around(-0.75), around(0.75)], TOLERANCE).unwrap();
    // It took 65: what turns against the base alone is looked at closer.
    assert!(found.certified_free_until == 1.0 && found.looked_at < 30, "{found:?}");
}

/// The base stands in what it is bolted to.
#[test]
fn a_link_may_touch_the_surroundings() {
    let mut checker = among(&wall(0.0), Touching::Surroundings);
    let path = [around(-0.3), around(0.3)];
    let touching = |checker: &RobotChecker| -> BTreeSet<String> {
        let found = checker.check(&query(), &path[0]).unwrap();
        found.pairs.into_iter().map(|pair| pair.b).collect()
    };
    let links = touching(&checker);
    assert!(links.contains("base"), "{links:?}");
    for link in &links {
        checker.allow(link, SURROUNDINGS).unwrap();
    }
    assert!(touching(&checker).is_empty());
    assert_eq!(checker.check_path(&query(), &path, TOLERANCE).unwrap().verdict(), Verdict::Free);
    // A link without a shape touches nothing anyway; that it is not in the scene is no slip.
    checker.allow("wrist_1", SURROUNDINGS).unwrap();
    let unknown = checker.allow("basis", SURROUNDINGS).unwrap_err().to_string();
    assert!(unknown.contains("`basis`"), "{unknown}");
}

/// A rod in the hand, so long that it meets the wall where the hand does not.
#[test]
fn what_the_hand_holds_goes_along_and_is_let_go() {
    let rod = Arc::new(Body::from(Mesh::prepare(&scene::cuboid([0.02, 0.02, 0.6])).unwrap()));
    let mut checker = among(&wall(1.1 * Arm::TOP), Touching::AndItself);
    let path = [around(-1.4), around(0.0)];
    let until = |checker: &RobotChecker| {
        checker.check_path(&query(), &path, TOLERANCE).unwrap().certified_free_until
    };
    assert_eq!(until(&checker), 1.0);
    // 40 cm of it are beyond the end of the hand.
    let ahead = Pose::from_translation(Vector3::new(0.0, 0.0, Arm::HAND + 0.1));
    checker.hold("rod", Arc::clone(&rod), "hand", ahead).unwrap();
    let found = checker.check(&query(), &path[1]).unwrap();
    let worst = found.pairs.first().map(|pair| (pair.a.as_str(), pair.b.as_str(), pair.verdict()));
    assert_eq!(worst, Some((SURROUNDINGS, "rod", Verdict::InCollision)), "{found:?}");
    // It reaches 1.4 m, and meets the edge of the wall, 39.5 cm aside, before its middle.
    let share = 1.0 - (0.395 / (1.1 * Arm::TOP)).atan() / 1.4;
    assert!((share - 0.1..share).contains(&until(&checker)), "{} {share}", until(&checker));
    assert!(checker.hold("rod", Arc::clone(&rod), "hand", ahead).is_err(), "the name is taken");
    assert!(checker.hold("bar", Arc::clone(&rod), "nobody", ahead).is_err());
    assert!(checker.hold("hand", Arc::clone(&rod), "hand", ahead).is_err(), "a link has that name");
    assert!(checker.release("hand").is_err(), "a link is not held");
    assert!(Arc::ptr_eq(&checker.release("rod").unwrap(), &rod));
    assert_eq!(until(&checker), 1.0);
}

/// A cart that slides past the shadow of a thin post, seen by a depth camera: in the shadow each position is
/// undecided, the middle of the path was found so, and yet the path was certified by what is on both sides of it.
#[test]
fn a_position_that_is_not_free_ends_what_is_certified() {
    const SIDE: f64 = 0.05;
    let urdf = format!(
        "<robot name='cart'><link name='rail'/><link name='cart'><collision><geometry>\
         <box size='{SIDE} {SIDE} {SIDE}'/></geometry></collision></link><joint name='x' type='prismatic'>\
         <parent link='rail'/><child link='cart'/><origin xyz='0 0 3.45'/><axis xyz='1 0 0'/>\
         <limit lower='-9' upper='9' effort='1' velocity='1'/></joint></robot>"
    );
    let (width, height, focal) = (640, 360, 400.0);
    let ray = |pixel: usize, count: usize| (pixel as f64 - 0.5 * (count - 1) as f64) / focal;
    let points = (0..width * height).map(|i| {
        let [x, y] = [ray(i % width, width), ray(i / width, height)];
        let depth = if x.abs() < 0.01 { 1.0 } else { 6.0 };
        Point3::new(x * depth, y * depth, depth)
    });
    let image = PointCloud {
        image_size: Some((width, height)),
        ..PointCloud::from_points(points.collect())
    };
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    let scan = Cloud::prepare(&image, &settings).unwrap().refined().unwrap();
    let robot = Arm::default().of(&urdf).unwrap();
    let touching = Touching::Surroundings;
    let checker = RobotChecker::new(robot, Body::from(scan), Pose::identity(), touching).unwrap();
    let at = |x: f64| BTreeMap::from([("x".to_owned(), x)]);
    let first = (0..200).map(|k| -0.3 + 0.003 * f64::from(k));
    let is_free = |x: f64| checker.check(&query(), &at(x)).unwrap().verdict() == Verdict::Free;
    let shadow = first.into_iter().find(|&x| !is_free(x)).unwrap();
    for [from, to] in [[-0.9, 0.9], [-1.1, 0.8], [-0.75, 1.05], [-0.8, 0.8]] {
        let found = checker.check_path(&query(), &[at(from), at(to)], TOLERANCE).unwrap();
        let until = from + (to - from) * found.certified_free_until;
        assert_ne!(found.verdict(), Verdict::Free, "{from} to {to}");
        assert!(
            until < 0.0,
            "{from} to {to} is certified until {until}, the shadow begins at {shadow}"
        );
    }
}
