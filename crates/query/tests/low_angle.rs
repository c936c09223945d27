//! Surfaces that a camera sees at a low angle.

use crate::common::{mesh, query};
use cloudtouch::geom::{PointCloud, Pose, Vector3, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mode, Verdict};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

/// A stereo camera of QVGA.
const FOCAL: f64 = 285.0;
const BASELINE: f64 = 0.055;
const DISPARITY_STD: f64 = 0.06;
const STEREO: SensorModel =
    SensorModel::Stereo { baseline: BASELINE, focal_px: FOCAL, disparity_std: DISPARITY_STD };

/// The camera so far above the board of a shelf, m, before the wall behind it; in the frame of the camera.
fn along_a_board(height: f64, seed: u64) -> PointCloud {
    let part = |size, y, z| {
        let at = Pose::from_translation(Vector3::new(0.0, y, z));
        ExactMesh::new(&scene::moved(&scene::cuboid(size), &at))
    };
    let board = part([1.6, 0.02, 0.6], height + 0.01, 0.85);
    let wall = part([3.0, 3.0, 0.02], 0.0, 1.16);
    let camera = DepthCamera {
        width: 320,
        height: 240,
        focal_px: FOCAL,
        depth_std: 0.0,
        depth_std_growth: DISPARITY_STD / (FOCAL * BASELINE),
        veil_probability: 0.3,
        ..DepthCamera::default()
    };
    camera.scan(&[&board, &wall], &Pose::identity(), seed)
}

/// Of a board at 4 to 9 degrees from half to two thirds of the returns were taken for veil, and whatever was pushed
/// through it was free.
#[test]
fn a_board_at_a_low_angle_was_taken_for_veil() {
    let finger = mesh(&scene::cuboid([0.02, 0.12, 0.02]));
    for (height, seed) in [(0.05, 1), (0.08, 2), (0.12, 3)] {
        let frame = along_a_board(height, seed);
        let cloud = Cloud::prepare(&frame, &CloudSettings::new(STEREO)).unwrap();
        let veil = cloud.filter_stages().iter().find(|stage| stage.stage == "veil").unwrap();
        assert!((veil.removed as f64) < 0.002 * veil.before as f64, "{height} m: {veil:?}");
        for along in 0..9 {
            let place = Vector3::new(-0.2 + 0.05 * f64::from(along), height - 0.06, 0.85);
            // The tip 1 cm under the board's top, then 3 cm above it.
            for (down, expected) in [(0.01, Verdict::InCollision), (-0.03, Verdict::Free)] {
                let pose = Pose::from_translation(place + Vector3::y() * down);
                let report = query(Mode::Calibrated).run(&cloud, &finger, &pose).unwrap();
                let p = report.collision_probability;
                let is_right = match expected {
                    Verdict::Free => report.verdict != Verdict::InCollision,
                    _ => report.verdict != Verdict::Free && p > 0.5,
                };
                assert!(is_right, "{height} m, {place:?}, {down}: {p} {:?}", report.verdict);
            }
        }
    }
}

/// Rods of a few pixels that recede aslant, and boards over a few rows of a coarse image, are taken for veil: their rays
/// were looked past, and 26 of 480 and 84 of 1,120 fingers pushed through were free.
#[test]
fn what_was_taken_for_veil_was_looked_past() {
    let at = |x, y, z| Pose::from_translation(Vector3::new(x, y, z));
    let stereo = |width: usize, height: usize, focal_px: f64, pixels_std: f64| {
        let camera = DepthCamera {
            width,
            height,
            focal_px,
            depth_std: 0.0,
            depth_std_growth: pixels_std / (focal_px * BASELINE),
            veil_probability: 0.0,
            ..DepthCamera::default()
        };
        let sensor =
            SensorModel::Stereo { baseline: BASELINE, focal_px, disparity_std: pixels_std };
        (camera, sensor)
    };
    let wall = ExactMesh::new(&scene::moved(&scene::cuboid([6.0, 6.0, 0.02]), &at(0.0, 0.0, 2.0)));
    let rod = |radius| {
        scene::tube(
            &[at(0.06, 0.06, 0.5), at(0.06, 0.06, 1.6)].map(|end| end.translation().into()),
            radius,
            16,
        )
    };
    let board = scene::moved(&scene::cuboid([1.6, 0.02, 0.5]), &at(0.0, 0.13, 0.9));
    let along_rod: Vec<Pose> =
        (0..20).map(|k| at(0.06, 0.06, 0.6 + 0.045 * f64::from(k))).collect();
    let through_board: Vec<Pose> =
        (0..9).map(|k| at(-0.2 + 0.05 * f64::from(k), 0.08, 0.9)).collect();
    let (across, down) = ([0.12, 0.02, 0.02], [0.02, 0.12, 0.02]);
    let cases = [
        (stereo(320, 240, 285.0, 0.06), rod(0.004), across, &along_rod),
        (stereo(640, 480, 525.0, 0.11), rod(0.004), across, &along_rod),
        (stereo(80, 60, 70.0, 0.015), board, down, &through_board),
    ];
    for ((camera, sensor), thing, finger, poses) in cases {
        let image = camera.scan(&[&ExactMesh::new(&thing), &wall], &Pose::identity(), 3);
        let cloud = Cloud::prepare(&image, &CloudSettings::new(sensor)).unwrap();
        let veil = cloud.filter_stages().iter().find(|stage| stage.stage == "veil").unwrap();
        assert!(veil.removed > 50, "{veil:?}");
        let finger = mesh(&scene::cuboid(finger));
        for pose in poses {
            let report = query(Mode::Calibrated).run(&cloud, &finger, pose).unwrap();
            assert_ne!(report.verdict, Verdict::Free, "{sensor:?} {pose:?}");
        }
    }
}

/// Beside rows without a return, written as the place of the camera, 213 returns were taken for veil, and such an image
/// moved to the frame of the world was doubted.
#[test]
fn the_place_of_the_camera_for_no_return_is_no_neighbor() {
    let frame = along_a_board(0.3, 4);
    let world_from_camera =
        Pose::from_translation_rpy(Vector3::new(1.3, -0.4, 0.7), [0.3, 2.0, -0.5]);
    let lost = |index: usize| seed::unit(seed::derive(5, index as u64, 0)) < 0.3;
    let written = |pose: Pose, none: Vector3| {
        let mut image = PointCloud { sensor_pose: Some(pose), ..frame.clone() };
        for (index, point) in image.points.iter_mut().enumerate() {
            let place = if lost(index) { none.into() } else { *point };
            *point = pose.transform_point(&place);
            // As a driver writes it.
            point.coords.apply(|value| *value = f64::from(*value as f32));
        }
        Cloud::prepare(&image, &CloudSettings::new(STEREO)).unwrap()
    };
    let none = Vector3::repeat(f64::NAN);
    for pose in [Pose::identity(), world_from_camera] {
        let [with_nan, with_zeros] = [none, Vector3::zeros()].map(|none| written(pose, none));
        let veil = |cloud: &Cloud| {
            let stages = cloud.filter_stages().iter();
            stages.filter(|stage| stage.stage == "veil").map(|stage| stage.removed).sum::<usize>()
        };
        assert_eq!(veil(&with_zeros), veil(&with_nan));
        let finger = mesh(&scene::cuboid([0.02, 0.12, 0.02]));
        let there = pose.after(&Pose::from_translation(Vector3::new(0.0, 0.1, 0.8)));
        let [a, b] = [&with_nan, &with_zeros]
            .map(|cloud| query(Mode::Calibrated).run(cloud, &finger, &there).unwrap().verdict);
        assert_eq!(a, b);
    }
}
