//! Points come as files have them: of pairs, of faces, of rows in turn.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use crate::common::scenes::{cloud, mesh, query};
use crate::common::{at, uniform};
use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Path, Undecided, Verdict};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::{scene, surface};

fn prepared(points: Vec<Point3>, std: f64) -> Cloud {
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap()
}

/// Every so-manieth point was of one finger, and the other, deep in a block, counted as seen.
#[test]
fn a_tool_whose_fingers_come_in_turn_read_free_with_one_of_them_in_a_block() {
    let wall = scene::moved(&scene::cuboid([6.0, 6.0, 0.02]), &at(0.0, 0.0, 2.5));
    let block = scene::moved(&scene::cuboid([0.4, 0.4, 0.6]), &at(-0.3, 0.0, 1.3));
    let [wall, block] = [wall, block].map(|mesh| ExactMesh::new(&mesh));
    let camera = DepthCamera { veil_probability: 0.0, ..DepthCamera::default() };
    let image = camera.scan(&[&wall, &block], &Pose::identity(), 1);
    let image = Cloud::prepare(&image, &CloudSettings::new(SensorModel::Kinect)).unwrap();
    let finger = surface::sample_surface(&scene::cuboid([0.03, 0.1, 0.03]), 4000, 3);
    let both = |p: Point3| [1.0, -1.0].map(|side| Point3::new(side * (p.x + 0.3), p.y, p.z));
    let tool = prepared(surface::positions(&finger).into_iter().flat_map(both).collect(), 0.0005);
    let report = query().run(&image, &tool, &at(0.0, 0.0, 1.35)).unwrap();
    assert_eq!(report.undecided_by, Some(Undecided::Unseen), "{report:?}");
    assert!((report.unseen.unwrap().share() - 0.5).abs() < 0.05, "{:?}", report.unseen);
    let path = Path::linear(&at(0.0, -0.001, 1.35), &at(0.0, 0.001, 1.35)).unwrap();
    let swept = query().sweep(&image, &tool, &path, 0.1).unwrap();
    assert_eq!((swept.verdict, swept.undecided_by), (Verdict::Undecided, Some(Undecided::Unseen)));
}

/// Every so-manieth point was of one face, which is not all around.
#[test]
fn a_body_in_a_closed_cloud_whose_faces_come_in_turn_read_free() {
    let side = 64_u64;
    let place = |k: u64| (k as f64 + 0.5) / side as f64 - 0.5;
    let off = |k: u64| 0.004 * (uniform(5, k) - 0.5);
    let point = |k: u64| {
        let (face, at) = (k % 6, k / 6);
        let across = [if face % 2 == 0 { 0.5 } else { -0.5 }, place(at / side), place(at % side)];
        let axis = (face / 2) as usize;
        let [x, y, z] = [0, 1, 2].map(|d| across[(d + 3 - axis) % 3] + off(3 * k + d as u64));
        Point3::new(x, y, z)
    };
    let carton = prepared((0..6 * side * side).map(point).collect(), 0.002);
    let cube = scene::cuboid([0.1; 3]);
    for inside in [mesh(&cube), cloud(&cube, 0.01, 0.001, 2)] {
        for k in 0..27_u64 {
            let [x, y, z] = [k % 3, k / 3 % 3, k / 9].map(|d| 0.25 * (d as f64 - 1.0));
            let inside: &Body = &inside;
            let report = query().run(&carton, inside, &at(x, y, z)).unwrap();
            assert_eq!(report.undecided_by, Some(Undecided::Enclosed), "{x} {y} {z}");
        }
    }
    let out = query().run(&carton, &mesh(&cube), &Pose::from_translation(Vector3::x())).unwrap();
    assert_eq!(out.verdict, Verdict::Free);
}
