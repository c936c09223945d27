//! Low things that go from a table that a camera keeps up to date.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use crate::common::{at, mesh};
use cloudtouch::geom::nalgebra::{Matrix4, Point3 as Place};
use cloudtouch::geom::{PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Verdict};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

/// Of the camera, at a metre.
const STD: f64 = 0.003;

/// A metre from the middle of the table, looking at it so many degrees below the horizon.
fn looking_down(degrees: f64) -> Pose {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let ahead = Vector3::new(0.0, cos, -sin);
    let right = Vector3::x();
    let down = ahead.cross(&right);
    let mut matrix = Matrix4::identity();
    for (column, axis) in [right, down, ahead, -ahead].iter().enumerate() {
        matrix.fixed_view_mut::<3, 1>(0, column).copy_from(axis);
    }
    Pose::try_from_matrix(&matrix).unwrap()
}

fn frame(meshes: &[&ExactMesh], place: &Pose, seed: u64) -> PointCloud {
    let camera = DepthCamera { depth_std: STD, depth_std_growth: 0.0, ..DepthCamera::default() };
    camera.scan(meshes, place, seed).transformed(place)
}

/// Of places over where the plate was, at how many a box so far over the table reads as this.
fn count(cloud: &Cloud, gap: f64, wanted: Verdict) -> usize {
    let query = Query::new(QuerySettings::default()).unwrap();
    let tool = mesh(&scene::cuboid([0.03, 0.03, 0.1]));
    let places = (-2..=2).flat_map(|x| (-2..=2).map(move |y| [x, y].map(|k| 0.03 * f64::from(k))));
    let is = |[x, y]: [f64; 2]| {
        query.run(cloud, &tool, &at(x, y, gap + 0.05)).unwrap().verdict == wanted
    };
    places.filter(|place| is(*place)).count()
}

/// Its points were gone only where every return about them was behind them by three deviations of both: a table has its
/// nearest return by six deviations and two pixels of slope before it, and what is lower stayed for ever.
#[test]
fn a_plate_taken_from_a_table_left_its_points() {
    let table = ExactMesh::new(&scene::plane_patch(2.0));
    for (height, first) in [(6.0, 45.0), (6.0, 85.0), (10.0, 30.0)] {
        let height = height * STD;
        let plate = scene::moved(&scene::cuboid([0.15, 0.15, height]), &at(0.0, 0.0, 0.5 * height));
        let plate = ExactMesh::new(&plate);
        let by = CloudSettings::new(SensorModel::Isotropic { std: STD });
        let start = frame(&[&table, &plate], &looking_down(first), 1);
        let mut cloud = Cloud::prepare(&start, &by).unwrap();
        let mut fresh = None;
        assert_eq!(count(&cloud, 0.8 * height, Verdict::InCollision), 25, "{height}");
        for step in 1..=3 {
            let place = looking_down(first + 3.0 * f64::from(step));
            let seen = frame(&[&table], &place, 10 + step as u64);
            cloud.replace_frame(&seen, &by).unwrap();
            fresh = Some(Cloud::prepare(&seen, &by).unwrap());
        }
        let is_above = |p: &Place<f64>| p.x.abs() < 0.07 && p.y.abs() < 0.07 && p.z > height - STD;
        let left = (0..cloud.len()).filter(|&i| is_above(&cloud.point(i))).count();
        assert!(left <= 5, "{left} points {height} m high by a camera at {first} degrees");
        let free = |cloud: &Cloud| count(cloud, 0.8 * height, Verdict::Free);
        let (free, of_fresh) = (free(&cloud), free(&fresh.unwrap()));
        assert!(
            of_fresh >= 20 && free + 2 >= of_fresh,
            "{height} at {first}: {free} of {of_fresh}"
        );
    }
}

#[test]
fn a_bar_that_still_lies_there_stays_as_a_fresh_frame_has_it() {
    let table = ExactMesh::new(&scene::plane_patch(2.0));
    let side = 5.0 * STD;
    let bar = scene::moved(&scene::cuboid([0.3, side, side]), &at(0.0, 0.0, 0.5 * side));
    let bar = ExactMesh::new(&bar);
    let by = CloudSettings::new(SensorModel::Isotropic { std: STD });
    let seen = |step: i32| {
        frame(&[&table, &bar], &looking_down(f64::from(45 + 4 * step)), 20 + step as u64)
    };
    let mut cloud = Cloud::prepare(&seen(0), &by).unwrap();
    for step in 1..=4 {
        cloud.replace_frame(&seen(step), &by).unwrap();
    }
    let fresh = Cloud::prepare(&seen(4), &by).unwrap();
    let (query, tool) =
        (Query::new(QuerySettings::default()).unwrap(), mesh(&scene::cuboid([0.03, 0.03, 0.1])));
    let is_hit = |cloud: &Cloud, x: f64| {
        let report = query.run(cloud, &tool, &at(x, 0.0, 0.4 * side + 0.05)).unwrap();
        assert_ne!(report.verdict, Verdict::Free, "{x}: {report:?}");
        report.verdict == Verdict::InCollision
    };
    let hits = |cloud: &Cloud| (-10..=10).filter(|k| is_hit(cloud, 0.012 * f64::from(*k))).count();
    let (kept, of_fresh) = (hits(&cloud), hits(&fresh));
    assert!(of_fresh >= 18 && kept >= of_fresh, "{kept} of {of_fresh}");
}
