//! Slips about what sees: what a camera did not look at, where it stood, and what it is.

use std::sync::Arc;

use crate::common::{AnyQuery, MODES, Scan, ask, at, measured, mesh};
use crate::slips::{NOISE, check, table, tool};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, FilterSettings, Mode, PaperCloud, PaperCloudSettings, PrepareError,
    Report, Safeguards, SelfMesh, Undecided, Unseen, Verdict, Warning,
};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

/// A wall 2 m before the camera with a window of half a metre, and a block of 40 cm before it.
fn image() -> PointCloud {
    let wall = |x: f64| scene::moved(&scene::cuboid([1.0, 6.0, 0.02]), &at(x, 0.0, 2.0));
    let around =
        ExactMesh::new(&scene::assemble([wall(-0.75), wall(0.75), wall(-1.75), wall(1.75)]));
    let block = ExactMesh::new(&scene::moved(&scene::cuboid([0.4; 3]), &at(-0.5, 0.0, 1.2)));
    DepthCamera::default().scan(&[&around, &block], &Pose::identity(), 1)
}

fn look(pose: &Pose, mode: Mode) -> Report {
    let cloud = Scan::of(&image(), SensorModel::Kinect, mode).expect("a good image");
    ask(mode, &cloud, &mesh(&scene::sphere(0.06, 2)), pose)
}

/// Half of the object at least is unseen for the one reason, and nothing for another.
#[test]
fn what_the_camera_did_not_see_read_free() {
    type Share = fn(&Unseen) -> f64;
    let cases: [(&str, Pose, Share); 4] = [
        ("behind the camera", at(0.1, 0.0, -0.8), |u| u.behind_camera),
        ("beside the view", at(2.2, 0.0, 1.5), |u| u.outside_view),
        ("before a hole", at(0.0, 0.0, 1.6), |u| u.hole),
        ("behind the block", at(-0.65, 0.0, 1.7), |u| u.behind_returns),
    ];
    for (name, pose, share) in cases {
        for mode in MODES {
            let report = look(&pose, mode);
            let unseen = report.unseen.expect("an image");
            assert!(share(&unseen) > 0.5, "{name}, {mode:?}: {unseen:?}");
            assert_eq!(report.verdict, Verdict::Undecided, "{name}, {mode:?}: {report:?}");
            assert_eq!(report.undecided_by, Some(Undecided::Unseen), "{name}, {mode:?}");
        }
    }
    let before = look(&at(0.6, 0.0, 1.2), Mode::Calibrated);
    assert_eq!((before.verdict, before.warnings.len()), (Verdict::Free, 0), "{before:?}");
    assert_eq!(before.unseen.expect("an image").share(), 0.0);
}

/// Where the sensor stood was in millimetres: only its noise was told of. A million times as far it was believed.
#[test]
fn a_place_of_the_sensor_that_cannot_be_meant_is_told_as_one() {
    let from = |z: f64| PointCloud { sensor_pose: Some(at(0.0, 0.0, z)), ..table() };
    for mode in MODES {
        let error = Scan::of(&from(2000.0), SensorModel::Kinect, mode).unwrap_err();
        let told = matches!(error, PrepareError::NoiseBeyondSize { range: Some(range), .. } if range > 1e3);
        assert!(told && error.to_string().contains("stood 2000 m from its points"), "{error}");
        let error = Scan::of(&from(1e12), NOISE, mode).unwrap_err();
        assert!(matches!(error, PrepareError::SensorPose { value: 1e12 }), "{error}");
    }
}

/// A lesser doubt, of how the camera was turned or of what kind it is, kept its place from being doubted.
#[test]
fn a_wrong_place_was_not_noticed_beside_a_wrong_turn_or_kind() {
    let wall = ExactMesh::new(&scene::moved(&scene::cuboid([6.0, 6.0, 0.02]), &at(0.0, 0.0, 2.5)));
    let block = ExactMesh::new(&scene::moved(&scene::cuboid([0.3, 0.4, 0.6]), &at(0.0, 0.0, 1.3)));
    let camera = DepthCamera { veil_probability: 0.0, ..DepthCamera::default() };
    let image = camera.scan(&[&wall, &block], &Pose::identity(), 1);
    let ball = mesh(&scene::sphere(0.04, 3));
    let half_turn = Pose::from_translation_rpy(Vector3::zeros(), [std::f64::consts::PI, 0.0, 0.0]);
    let laser = SensorModel::Lidar { range_std: 0.005, beam_rad: 0.002 };
    let beside = at(0.9, 0.0, 0.0);
    for (sensor, pose) in [
        (SensorModel::Kinect, beside),
        (SensorModel::Kinect, beside.after(&half_turn)),
        (laser, beside),
        (laser, beside.after(&half_turn)),
    ] {
        let scan = PointCloud { sensor_pose: Some(pose), ..image.clone() };
        let cloud = Scan::of(&scan, sensor, Mode::Calibrated).expect("a good image");
        for x in [-0.09, 0.03, 0.09] {
            let report = ask(Mode::Calibrated, &cloud, &ball, &at(x, 0.04, 1.34));
            assert_eq!(report.verdict, Verdict::Undecided, "{sensor:?} {pose:?} {x}: {report:?}");
        }
    }
    // Where only the turn is wrong it is only told.
    let scan = PointCloud { sensor_pose: Some(half_turn), ..image };
    let cloud = Scan::of(&scan, SensorModel::Kinect, Mode::Calibrated).expect("a good image");
    let report = ask(Mode::Calibrated, &cloud, &ball, &at(0.6, 0.0, 1.2));
    let told = |warning: &Warning| matches!(warning, Warning::SensorTurn { .. });
    assert!(report.verdict == Verdict::Free && report.warnings.iter().any(told), "{report:?}");
}

/// A rod a few pixels wide nearer than 10 cm was left out, and what it hid counted as seen, where no least range was
/// stated.
#[test]
fn what_a_thin_thing_near_the_camera_hides_is_unseen() {
    let camera = DepthCamera {
        width: 160,
        height: 120,
        focal_px: 140.0,
        veil_probability: 0.0,
        depth_std: 0.0005,
        ..DepthCamera::default()
    };
    let wall = ExactMesh::new(&scene::moved(&scene::cuboid([6.0, 6.0, 0.02]), &at(0.0, 0.0, 2.5)));
    for pixels in [2.0, 4.0] {
        let rod = scene::cuboid([pixels / 140.0 * 0.08, 0.3, 0.001]);
        let rod = ExactMesh::new(&scene::moved(&rod, &at(0.0, 0.0, 0.08)));
        let image = camera.scan(&[&wall, &rod], &Pose::identity(), 1);
        let cloud = Scan::of(&image, SensorModel::Kinect, Mode::Calibrated).expect("a good image");
        let slat = mesh(&scene::cuboid([0.6 * pixels / 140.0, 0.3, 0.01]));
        let report = ask(Mode::Calibrated, &cloud, &slat, &at(0.0, 0.0, 1.0));
        assert_eq!(report.undecided_by, Some(Undecided::Unseen), "{pixels}: {report:?}");
    }
}

/// The base of the robot was wrong: nothing of the image lies on it, and space behind the block counted as seen
/// for being within it.
#[test]
fn a_robot_that_no_return_came_from_made_space_known() {
    let pose = at(-0.65, 0.0, 1.7);
    let with = |link: TriangleMesh, cloud_from_link| {
        let robot = vec![SelfMesh { mesh: Arc::new(mesh(&link)), cloud_from_link, padding: 0.0 }];
        let filter = FilterSettings { robot, ..FilterSettings::for_sensor(&SensorModel::Kinect) };
        let settings = CloudSettings { filter, ..CloudSettings::new(SensorModel::Kinect) };
        let cloud = Scan::Calibrated(Cloud::prepare(&image(), &settings).expect("a good image"));
        ask(Mode::Calibrated, &cloud, &mesh(&scene::sphere(0.06, 2)), &pose)
    };
    let behind = with(scene::sphere(0.1, 2), pose);
    assert_eq!(behind.undecided_by, Some(Undecided::Unseen), "{behind:?}");
    assert!(behind.warnings.iter().any(|w| matches!(w, Warning::NoRobot { .. })), "{behind:?}");
    // One that the image shows, and that reaches behind what it shows.
    let shown = with(scene::cuboid([0.3, 0.3, 1.5]), pose);
    assert_eq!(shown.unseen.expect("an image").share(), 0.0, "{shown:?}");
}

/// The table was left out as too far away, and nothing was in the way any more.
#[test]
fn what_lies_beyond_the_range_kept_read_free() {
    let filter = FilterSettings { max_range: 0.25, ..FilterSettings::default() };
    let kept = |mode| match mode {
        Mode::Calibrated => {
            let settings = CloudSettings { filter: filter.clone(), ..CloudSettings::new(NOISE) };
            Scan::Calibrated(Cloud::prepare(&table(), &settings).expect("points are left"))
        }
        Mode::Paper => {
            let settings =
                PaperCloudSettings { filter: filter.clone(), ..PaperCloudSettings::amended(NOISE) };
            Scan::Paper(PaperCloud::prepare(&table(), &settings).expect("points are left"))
        }
    };
    let told = |w: &Warning| matches!(w, Warning::Unseen { share, .. } if *share > 0.9);
    check(kept, &mesh(&tool()), &at(0.4, 0.2, 0.0), Undecided::Unseen, told);
    let unseen = |pose| {
        let small = mesh(&scene::sphere(0.02, 2));
        ask(Mode::Calibrated, &kept(Mode::Calibrated), &small, &pose).unseen.expect("a range")
    };
    assert!(unseen(at(0.4, 0.2, 0.1)).out_of_range > 0.9);
    assert_eq!(unseen(at(0.1, 0.1, 0.1)).share(), 0.0);
}

/// Whatever frame the points are in: the camera is where the file says, its turn is seen from them.
#[test]
fn a_turned_image_sees_the_same() {
    let turn = Pose::from_translation_rpy(Vector3::new(1.0, -2.0, 0.5), [0.4, -1.2, 2.5]);
    let image = image();
    let points = image.points.iter().map(|p| turn.transform_point(p)).collect();
    let turned = PointCloud { points, sensor_pose: Some(turn), ..image };
    let cloud = Scan::of(&turned, SensorModel::Kinect, Mode::Calibrated).expect("a good image");
    let ball = mesh(&scene::sphere(0.06, 2));
    for (pose, verdict) in [
        (at(-0.65, 0.0, 1.7), Verdict::Undecided),
        (at(0.1, 0.0, -0.8), Verdict::Undecided),
        (at(0.6, 0.0, 1.2), Verdict::Free),
    ] {
        let report = ask(Mode::Calibrated, &cloud, &ball, &turn.after(&pose));
        assert_eq!(report.verdict, verdict, "{pose:?}: {report:?}");
    }
}

/// The cells of the view were turned at random against its rows, and what is at its rim with them.
#[test]
fn how_much_was_unseen_hung_on_the_frame() {
    let ball = mesh(&scene::sphere(0.06, 2));
    // At the rim of the view, of the window and of the block.
    let poses = [at(1.12, 0.0, 2.0), at(-1.1, 0.8, 1.9), at(0.24, 0.3, 1.9), at(-0.3, 0.2, 1.5)];
    let shares = |turn: &Pose| {
        let moved = PointCloud { sensor_pose: Some(Pose::identity()), ..image() }.transformed(turn);
        let cloud = Scan::of(&moved, SensorModel::Kinect, Mode::Calibrated).expect("a good image");
        poses.map(|pose| {
            let report = ask(Mode::Calibrated, &cloud, &ball, &turn.after(&pose));
            report.unseen.expect("an image").share()
        })
    };
    let expected = shares(&Pose::identity());
    assert!(
        expected.iter().filter(|share| (0.05..0.95).contains(*share)).count() > 1,
        "{expected:?}"
    );
    for k in 0..8 {
        let angle = |axis| 6.3 * seed::unit(seed::derive(5, k, axis)) - 3.15;
        let turn = Pose::from_translation_rpy(
            Vector3::new(1.0, -2.0, 0.5),
            [angle(0), angle(1), angle(2)],
        );
        for (found, expected) in shares(&turn).into_iter().zip(expected) {
            assert!((found - expected).abs() < 0.02, "{k}: {found} {expected}");
        }
    }
}

#[test]
fn the_limit_on_what_is_unseen_can_be_set() {
    let safeguards = Safeguards { max_unseen: 1.0, ..Safeguards::default() };
    let query = AnyQuery::with(Mode::Calibrated, |by| by.safeguards = safeguards, |_| {});
    let cloud = Scan::of(&image(), SensorModel::Kinect, Mode::Calibrated).expect("a good image");
    let ball = mesh(&scene::sphere(0.06, 2));
    let report = query.run(&cloud, &ball, &at(2.2, 0.0, 1.5)).expect("a good pose");
    assert_eq!(report.verdict, Verdict::Free, "{report:?}");
    assert!(report.unseen.expect("an image").outside_view > 0.9);
}

#[test]
fn a_sensor_that_cannot_have_seen_the_cloud_read_free() {
    // The image in a frame with x forward, without a word of where the camera is.
    let forward = |p: &Point3| Point3::new(p.z, -p.x, -p.y);
    let image = image();
    let points = image.points.iter().map(forward).collect();
    let base = PointCloud { points, ..image };
    let kinect = |cloud: &PointCloud| {
        let cloud = cloud.clone();
        move |mode| Scan::of(&cloud, SensorModel::Kinect, mode).expect("a cloud")
    };
    let ball = mesh(&scene::sphere(0.06, 2));
    let told = |w: &Warning| matches!(w, Warning::SensorPose { share, .. } if *share > 0.1);
    check(kinect(&base), &ball, &at(1.2, -0.6, 0.0), Undecided::Sensor, told);
    // A street seen from 70 m.
    let points = measured(&scene::plane_patch(20.0), 0.3, 0.02, 3);
    let street: Vec<Point3> = points.iter().map(|p| Point3::new(p.x, p.y, p.z + 70.0)).collect();
    let told = |w: &Warning| matches!(w, Warning::SensorRange { range_m, .. } if *range_m > 69.0);
    let car = mesh(&scene::cuboid([3.0; 3]));
    for mode in MODES {
        let cloud = kinect(&PointCloud::from_points(street.clone()))(mode);
        let report = ask(mode, &cloud, &car, &at(0.0, 0.0, 10.0));
        assert_ne!(report.verdict, Verdict::Free, "{mode:?}: {report:?}");
        assert!(report.warnings.iter().any(told), "{report:?}");
    }
}

/// A camera that looks backwards, or whose turn is that from the file into it: it was passed over.
#[test]
fn a_turn_that_is_not_believed_was_passed_over_in_silence() {
    let turned = |yaw: f64| {
        let sensor_pose = Some(Pose::from_translation_rpy(Vector3::zeros(), [0.0, yaw, 0.0]));
        let image = PointCloud { sensor_pose, ..image() };
        let cloud = Scan::of(&image, SensorModel::Kinect, Mode::Calibrated).expect("a cloud");
        ask(Mode::Calibrated, &cloud, &mesh(&tool()), &at(0.6, 0.0, 1.2)).warnings
    };
    let told = |w: &Warning| matches!(w, Warning::SensorTurn { share, .. } if *share > 0.9);
    assert!(turned(3.1).iter().any(told));
    assert!(!turned(0.0).iter().any(told));
}

#[test]
fn a_laser_scanner_with_the_image_of_a_camera_is_warned_of() {
    let sensor = SensorModel::Lidar { range_std: 0.02, beam_rad: 0.003 };
    let cloud = Scan::of(&image(), sensor, Mode::Calibrated).expect("a cloud");
    let report = ask(Mode::Calibrated, &cloud, &mesh(&tool()), &at(0.4, 0.0, 1.2));
    assert!(matches!(report.warnings[..], [Warning::SensorLayout { .. }]), "{report:?}");
}
