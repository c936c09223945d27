//! What a self filter takes for the robot is the robot, or nothing reads as free there.

use std::sync::Arc;

use crate::common::{at, measured, mesh};
use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, Query, QuerySettings, Report, SelfMesh, Undecided, Verdict, Warning,
};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

const BAR: [f64; 3] = [0.4, 0.06, 0.06];

/// A bar that is said to have been there when the scan was taken.
fn link(cloud_from_link: Pose, padding: f64) -> SelfMesh {
    SelfMesh { mesh: Arc::new(mesh(&scene::cuboid(BAR))), cloud_from_link, padding }
}

fn prepared(scan: &PointCloud, std: f64, robot: Vec<SelfMesh>) -> Cloud {
    let mut settings = CloudSettings::new(SensorModel::Isotropic { std });
    settings.filter.robot = robot;
    Cloud::prepare(scan, &settings).expect("a good scan")
}

fn ask(cloud: &Cloud, pose: &Pose) -> Report {
    let query = Query::new(QuerySettings::default()).expect("good settings");
    query.run(cloud, &mesh(&scene::cuboid(BAR)), pose).expect("an answer")
}

/// A bar so high over a table.
fn over(gap: f64) -> Pose {
    at(0.0, 0.0, gap + 0.5 * BAR[2])
}

/// A table, and a bar 6 mm over it that was taken for the robot.
fn scan_of_table() -> PointCloud {
    let seen_top = scene::moved(&scene::cuboid([BAR[0], BAR[1], 1e-4]), &over(0.006 + 0.03));
    let mut points: Vec<Point3> = measured(&scene::plane_patch(1.2), 0.01, 0.002, 1);
    points.extend(measured(&seen_top, 0.01, 0.002, 2));
    PointCloud::from_points(points)
}

/// The same without what is within 2 cm of the bar.
fn table_beside() -> Cloud {
    prepared(&scan_of_table(), 0.002, vec![link(over(0.006), 0.02)])
}

/// The bar was 6 mm over a table, which was taken for it within its padding; lowered into it, it read `free`.
#[test]
fn a_table_beside_the_robot_was_taken_for_it() {
    let cloud = table_beside();
    for gap in [-0.004, -0.008] {
        let report = ask(&cloud, &over(gap));
        assert_eq!(report.undecided_by, Some(Undecided::Missing), "{gap}: {report:?}");
        let says = |w: &Warning| matches!(w, Warning::TakenForRobot { share, .. } if *share > 0.01);
        assert!(report.warnings.iter().any(says), "{gap}: {report:?}");
    }
    for gap in [0.006, 0.012, 0.05] {
        assert_eq!(ask(&cloud, &over(gap)).verdict, Verdict::Free, "{gap}");
    }
    // By three standard deviations all that goes is the robot's.
    let close = prepared(&scan_of_table(), 0.002, vec![link(over(0.006), 0.005)]);
    assert_ne!(ask(&close, &over(-0.008)).verdict, Verdict::Free);
}

/// Poses that a way leads to were doubted when they were asked about, and no margin or bound about a pose knew of it: a
/// robot's path was certified into what it had cut out of the table.
#[test]
fn a_margin_reaches_what_was_taken_for_the_robot() {
    let (cloud, bar) = (table_beside(), mesh(&scene::cuboid(BAR)));
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let upper = |gap: f64, margin: f64| {
        let (report, within) = query.within(&cloud, &bar, &over(gap), margin).expect("an answer");
        assert_eq!(report.verdict, Verdict::Free, "{gap}");
        let around = query.bound_around(&cloud, &bar, &over(gap), margin).expect("a bound");
        [within.bounds[1], around]
    };
    for (gap, margin) in [(0.006, 0.006), (0.012, 0.012), (0.02, 0.016)] {
        assert_eq!(ask(&cloud, &over(gap - margin)).undecided_by, Some(Undecided::Missing));
        assert_eq!(upper(gap, margin), [1.0; 2], "{gap} {margin}");
        let [near, _] =
            query.clearance_interval(&cloud, &bar, &over(gap), 0.9).expect("an interval");
        assert!(near < gap, "{near} {gap}");
    }
    for (gap, margin) in [(0.03, 0.006), (0.05, 0.02)] {
        assert!(upper(gap, margin).iter().all(|upper| *upper < 0.1), "{gap} {margin}");
    }
}

/// The next frame looked to a wall, and what had been taken under the bar was forgotten with it.
#[test]
fn what_was_taken_is_known_until_a_frame_shows_what_is_there() {
    let over = |gap: f64| at(0.0, 0.0, 1.5 - gap - 0.5 * BAR[2]);
    let floor = scene::moved(&scene::plane_patch(4.0), &at(0.0, 0.0, 1.5));
    let wall = scene::moved(&scene::cuboid([0.02, 8.0, 8.0]), &at(3.0, 0.0, 0.0));
    let bar = scene::moved(&scene::cuboid(BAR), &over(0.006));
    let [floor, wall, bar] = [floor, wall, bar].map(|part| ExactMesh::new(&part));
    let camera = DepthCamera {
        veil_probability: 0.0,
        depth_std: 0.0005,
        depth_std_growth: 0.0003,
        ..DepthCamera::default()
    };
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.0015 });
    let scan = camera.scan(&[&floor, &wall, &bar], &Pose::identity(), 3);
    let mut cloud = prepared(&scan, 0.0015, vec![link(over(0.006), 0.02)]);
    let into_floor = [-0.004, -0.008].map(over);
    let turn = [0.0, std::f64::consts::FRAC_PI_2, 0.0];
    let to_wall = Pose::from_translation_rpy(Vector3::zeros(), turn);
    for seed in 4..7 {
        for pose in &into_floor {
            let report = ask(&cloud, pose);
            assert_eq!(report.undecided_by, Some(Undecided::Missing), "{seed}: {report:?}");
        }
        let frame = camera.scan(&[&floor, &wall], &to_wall, seed).transformed(&to_wall);
        cloud.replace_frame(&frame, &settings).expect("a good frame");
    }
    let frame = camera.scan(&[&floor, &wall], &Pose::identity(), 8);
    cloud.replace_frame(&frame, &settings).expect("a good frame");
    for pose in &into_floor {
        assert_eq!(ask(&cloud, pose).verdict, Verdict::InCollision);
    }
    assert_eq!(ask(&cloud, &over(0.03)).verdict, Verdict::Free);
}

/// Joints from another time cut the robot's shape out of what really is there, and it read `free` in it.
#[test]
fn a_robot_that_was_not_where_it_is_said_to_have_been_is_noticed() {
    let floor = scene::moved(&scene::plane_patch(4.0), &at(0.0, 0.0, 2.0));
    let carton = scene::moved(&scene::cuboid([0.3; 3]), &at(0.3, 0.0, 1.5));
    let bar = scene::moved(&scene::cuboid(BAR), &at(0.0, 0.0, 1.45));
    let [floor, carton, bar] = [floor, carton, bar].map(|part| ExactMesh::new(&part));
    let camera = DepthCamera::default();
    let image = |parts: &[&ExactMesh]| camera.scan(parts, &Pose::identity(), 3);
    let (with_robot, without) = (image(&[&floor, &carton, &bar]), image(&[&floor, &carton]));
    // With its end 5 cm in the carton, in a scan without it.
    let inside = at(0.0, 0.0, 1.45);
    let stale = ask(&prepared(&without, 0.003, vec![link(inside, 0.012)]), &inside);
    assert_eq!(stale.undecided_by, Some(Undecided::Missing), "{stale:?}");
    let says = |w: &Warning| matches!(w, Warning::RobotElsewhere { .. });
    assert!(stale.warnings.iter().any(says), "{stale:?}");
    // A mesh that is fatter than what it stands for is no sign of it.
    let fat = Vector3::new(0.0, 0.0, -0.02);
    for pose in [inside, at(0.0, 0.0, 1.45).after(&Pose::from_translation(fat))] {
        let report =
            ask(&prepared(&with_robot, 0.003, vec![link(pose, 0.03)]), &at(-0.5, 0.0, 1.4));
        assert!(!report.warnings.iter().any(says), "{report:?}");
    }
}
