//! A depth camera sees an arm over a table: the arm goes from its scan, the table stays.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::support::{Arm, joints};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Query, QuerySettings, Verdict};
use cloudtouch_robot::{Robot, RobotChecker, Touching};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use nalgebra::UnitQuaternion;

/// Three standard deviations at the distance of the arm, m.
const PADDING: f64 = 0.02;
/// Room between the table and the base, m: they would touch otherwise.
const LIFT: f64 = 0.05;

/// The camera looks down at the arm over the table.
fn world_from_camera() -> Pose {
    let at = Vector3::new(1.6, 0.3, 1.3);
    let ahead = Vector3::new(0.2, 0.0, 0.3) - at;
    // Its y points down, its z ahead.
    let turn = UnitQuaternion::face_towards(&ahead, &-Vector3::z());
    Pose::from_translation_rotation(at, turn)
}

fn table() -> TriangleMesh {
    let corner = |i: u32| {
        let side = |bit: u32, half: f64| if i >> bit & 1 == 1 { half } else { -half };
        Point3::new(side(0, 0.9), side(1, 0.9), side(2, 0.02) - 0.02)
    };
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new((0..8).map(corner).collect(), triangles).unwrap()
}

#[test]
fn an_arm_is_taken_out_of_the_scan_that_shows_it_and_the_table_stays() {
    let arm = Arm::default();
    let robot = arm.robot();
    let camera_from_world = world_from_camera().inverse();
    let world_from_base = Pose::from_translation(Vector3::new(0.0, 0.0, LIFT));
    let bent = joints([0.3, 0.6, 0.9, 0.2, 0.4, 0.0]);
    let links = robot.self_filter(&bent, &world_from_base, PADDING).unwrap();
    let links: Vec<ExactMesh> = links
        .iter()
        .map(|link| {
            let (vertices, triangles) = link.mesh.faces();
            let place = |p: &Point3| link.cloud_from_link.transform_point(p);
            let vertices = vertices.iter().map(place).collect();
            ExactMesh::new(&TriangleMesh::new(vertices, triangles.to_vec()).unwrap())
        })
        .collect();
    let table = ExactMesh::new(&table());
    let all: Vec<&ExactMesh> = links.iter().chain([&table]).collect();
    for veil_probability in [0.0, 0.3] {
        let camera = DepthCamera {
            width: 320,
            height: 240,
            focal_px: 280.0,
            veil_probability,
            ..DepthCamera::default()
        };
        let scan = camera.scan(&all, &world_from_camera(), 2011);
        // Which pixel shows the arm: where the table alone would be farther away, or nothing.
        let with = camera.true_depths(&all, &world_from_camera());
        let without = camera.true_depths(&[&table], &world_from_camera());
        let shows_arm: Vec<bool> =
            with.iter().zip(&without).map(|(a, b)| a < b || a.is_finite() && b.is_nan()).collect();

        let mut settings = CloudSettings::new(SensorModel::Kinect);
        settings.filter.veil = None;
        let camera_from_base = camera_from_world.after(&world_from_base);
        let as_seen = Cloud::prepare(&scan, &settings).unwrap();
        settings.filter.robot = robot.self_filter(&bent, &camera_from_base, PADDING).unwrap();
        let filtered = Cloud::prepare(&scan, &settings).unwrap();
        let mut is_kept = vec![false; scan.points.len()];
        filtered.rows().iter().for_each(|&row| is_kept[row] = true);

        let count = |is: &dyn Fn(usize) -> bool| {
            let seen = as_seen.rows().iter().filter(|&&row| is(row));
            let kept = seen.clone().filter(|&&row| is_kept[row]).count();
            (kept, seen.count())
        };
        let (arm_kept, arm_seen) = count(&|row| shows_arm[row]);
        let (table_kept, table_seen) = count(&|row| !shows_arm[row]);
        println!(
            "veil at {veil_probability} of the edges: of {arm_seen} points on the arm {arm_kept} stay, of \
             {table_seen} on the table {table_kept}"
        );
        // Of a thousand points three are beyond three standard deviations; one of the veil is anywhere
        // between the arm and what is behind it.
        let most = if veil_probability > 0.0 { 0.04 } else { 0.004 };
        assert!(arm_seen > 2000 && (arm_kept as f64) < most * arm_seen as f64);
        // The base is nearer to the table than no padding reaches: nothing of it goes but veil.
        assert!(table_seen > 20_000 && table_kept as f64 >= 0.999 * table_seen as f64);

        // What is left of the veil is for its own filter.
        settings.filter.veil = CloudSettings::new(SensorModel::Kinect).filter.veil;
        let with_filter = verdict(&robot, &scan, &settings, &camera_from_base, &bent);
        settings.filter.robot.clear();
        let without_filter = verdict(&robot, &scan, &settings, &camera_from_base, &bent);
        assert_eq!((with_filter, without_filter), (Verdict::Free, Verdict::InCollision));
    }
}

/// At the joints of the scan, where the arm touches nothing.
fn verdict(
    robot: &Robot,
    scan: &PointCloud,
    settings: &CloudSettings,
    camera_from_base: &Pose,
    at: &BTreeMap<String, f64>,
) -> Verdict {
    let body = Body::from(Cloud::prepare(scan, settings).unwrap());
    let around =
        RobotChecker::new(robot.clone(), body, *camera_from_base, Touching::Surroundings).unwrap();
    let query = Query::new(QuerySettings::default()).unwrap();
    around.check(&query, at).unwrap().verdict()
}

/// They were prepared for every scan anew: 2.4 s for ten links of 50,000 triangles.
#[test]
fn the_meshes_of_links_are_prepared_once_for_all_scans() {
    let robot = Arm::default().robot();
    let seen = |angle| robot.self_filter(&joints([angle; 6]), &Pose::identity(), PADDING).unwrap();
    let (before, now) = (seen(0.0), seen(0.5));
    assert!(before.len() == 5 && now.len() == 5);
    for (before, now) in before.iter().zip(&now) {
        assert!(Arc::ptr_eq(&before.mesh, &now.mesh));
    }
    assert_ne!(before[4].cloud_from_link, now[4].cloud_from_link);
}
