//! Surfaces that a camera sees at a low angle.

use crate::common::{mesh, query};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mode, OutlierSettings, Verdict};
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

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::from_translation(Vector3::new(x, y, z))
}

/// A thing before a wall so far away, m, as a stereo camera with so many pixels sees it, which knows disparities this well.
fn image_before_a_wall(
    thing: &TriangleMesh,
    wall: f64,
    [width, height]: [usize; 2],
    focal_px: f64,
    disparity_std: f64,
) -> (PointCloud, CloudSettings) {
    let camera = DepthCamera {
        width,
        height,
        focal_px,
        depth_std: 0.0,
        depth_std_growth: disparity_std / (focal_px * BASELINE),
        veil_probability: 0.0,
        ..DepthCamera::default()
    };
    let wall = scene::moved(&scene::cuboid([6.0, 6.0, 0.02]), &at(0.0, 0.0, wall));
    let [thing, wall] = [thing, &wall].map(ExactMesh::new);
    let image = camera.scan(&[&thing, &wall], &Pose::identity(), 3);
    let sensor = SensorModel::Stereo { baseline: BASELINE, focal_px, disparity_std };
    (image, CloudSettings::new(sensor))
}

/// The same, prepared.
fn before_a_wall(
    thing: &TriangleMesh,
    wall: f64,
    size: [usize; 2],
    focal_px: f64,
    disparity_std: f64,
) -> Cloud {
    let (image, settings) = image_before_a_wall(thing, wall, size, focal_px, disparity_std);
    Cloud::prepare(&image, &settings).expect("a usable image")
}

/// Of 480 fingers across rods of three to six pixels 26 were free.
#[test]
fn a_thin_rod_that_recedes_aslant_was_taken_for_veil() {
    let rod = [0.5, 1.6].map(|z| Point3::new(0.06, 0.06, z));
    let rod = scene::tube(&rod, 0.004, 16);
    let finger = mesh(&scene::cuboid([0.12, 0.02, 0.02]));
    for (size, focal_px, std) in [([320, 240], 285.0, 0.06), ([640, 480], 525.0, 0.11)] {
        let cloud = before_a_wall(&rod, 2.0, size, focal_px, std);
        for z in (0..20).map(|k| 0.6 + 0.045 * f64::from(k)) {
            let report = query(Mode::Calibrated).run(&cloud, &finger, &at(0.06, 0.06, z)).unwrap();
            assert_eq!(report.verdict, Verdict::InCollision, "{size:?} {z}");
        }
    }
}

/// Without the rows and columns of its image a rod that recedes went for veil, for its returns are on a line along their
/// rays, and nothing told that it had been there: of 120 fingers across such rods 114 were free.
#[test]
fn a_rod_that_recedes_was_taken_for_veil_in_a_cloud_without_pixels() {
    let finger = mesh(&scene::cuboid([0.03; 3]));
    for (x, y) in [(0.06, 0.06), (0.0, 0.1), (0.03, 0.02)] {
        let rod = scene::tube(&[0.5, 1.6].map(|z| Point3::new(x, y, z)), 0.004, 16);
        let (image, settings) = image_before_a_wall(&rod, 2.0, [320, 240], 285.0, 0.06);
        let returns = image.points.into_iter().filter(PointCloud::is_return).collect();
        let cloud = Cloud::prepare(&PointCloud::from_points(returns), &settings).unwrap();
        for z in (0..40).map(|k| 0.6 + 0.0235 * f64::from(k)) {
            let report = query(Mode::Calibrated).run(&cloud, &finger, &at(x, y, z)).unwrap();
            assert_ne!(report.verdict, Verdict::Free, "{x} {y} {z}");
        }
    }
}

/// A board over a few rows of a coarse image is taken for veil, and its rays were looked past: all fingers through it were
/// free.
#[test]
fn what_was_taken_for_veil_was_looked_past() {
    let board = scene::moved(&scene::cuboid([1.6, 0.02, 0.5]), &at(0.0, 0.09, 0.9));
    let cloud = before_a_wall(&board, 1.16, [80, 60], 70.0, 0.015);
    let veil = cloud.filter_stages().iter().find(|stage| stage.stage == "veil").unwrap();
    assert!(veil.removed > 50, "{veil:?}");
    let finger = mesh(&scene::cuboid([0.02, 0.12, 0.02]));
    for x in (0..9).map(|k| -0.2 + 0.05 * f64::from(k)) {
        let through = query(Mode::Calibrated).run(&cloud, &finger, &at(x, 0.03, 0.9)).unwrap();
        assert_eq!(through.verdict, Verdict::Undecided, "{x}");
        // Before the board and above it all is seen.
        let above = query(Mode::Calibrated).run(&cloud, &finger, &at(x, -0.1, 0.8)).unwrap();
        assert_eq!(above.verdict, Verdict::Free, "{x}");
    }
}

/// What the outlier stage takes from an image, such as a rod over few pixels, was looked past: of 40 fingers across it
/// 27 were free.
#[test]
fn what_was_taken_for_outliers_was_looked_past() {
    let rod = scene::tube(&[0.5, 1.9].map(|z| Point3::new(0.06, 0.06, z)), 0.006, 16);
    let (image, mut settings) = image_before_a_wall(&rod, 2.2, [160, 120], 140.0, 0.03);
    settings.filter.outliers = Some(OutlierSettings::default());
    let cloud = Cloud::prepare(&image, &settings).unwrap();
    let outliers = cloud.filter_stages().iter().find(|stage| stage.stage == "outliers").unwrap();
    assert!(outliers.removed > 10, "{outliers:?}");
    let finger = mesh(&scene::cuboid([0.04; 3]));
    for z in (0..40).map(|k| 0.64 + 0.028 * f64::from(k)) {
        let through = query(Mode::Calibrated).run(&cloud, &finger, &at(0.06, 0.06, z)).unwrap();
        assert_ne!(through.verdict, Verdict::Free, "{z}");
        // Beside the rod all is seen.
        let beside = query(Mode::Calibrated).run(&cloud, &finger, &at(-0.1, -0.1, z)).unwrap();
        assert_eq!(beside.verdict, Verdict::Free, "{z}");
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
