//! What is far behind a scene, with noise of metres, says nothing about what is near.

use crate::common::{mesh, query};
use cloudtouch::geom::{PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, FilterSettings, Mode, Undecided, Verdict};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

const STEREO: SensorModel =
    SensorModel::Stereo { baseline: 0.055, focal_px: 214.0, disparity_std: 0.1 };

/// A stereo camera that looks over a table at a wall so far away, m.
fn over_a_table(wall: f64) -> PointCloud {
    let at = |y, z| Pose::from_translation(Vector3::new(0.0, y, z));
    let part = |size, pose: Pose| ExactMesh::new(&scene::moved(&scene::cuboid(size), &pose));
    let table = part([1.6, 0.04, 1.0], at(0.42, 1.0));
    let wall = part([2.0 * wall, 2.0 * wall, 0.1], at(0.0, wall));
    let camera = DepthCamera {
        width: 320,
        height: 240,
        focal_px: 214.0,
        max_depth: 100.0,
        depth_std: 0.0,
        depth_std_growth: 0.1 / (0.055 * 214.0),
        veil_probability: 0.0,
        ..DepthCamera::default()
    };
    camera.scan(&[&table, &wall], &Pose::identity(), 5)
}

/// What is answered of a box of 26 cm at some places in the air over the table, at least 15 cm from it.
fn of_a_box_in_the_air(cloud: &Cloud) -> Vec<(Verdict, Option<Undecided>)> {
    let held = mesh(&scene::cuboid([0.2, 0.14, 0.1]));
    let places = [[0.0, 0.0, 0.7], [-0.2, -0.1, 0.8], [0.25, 0.05, 0.9], [0.1, -0.15, 1.1]];
    let ask = |place: [f64; 3]| {
        let pose = Pose::from_translation(place.into());
        let report = query(Mode::Calibrated).run(cloud, &held, &pose).expect("good bodies");
        (report.verdict, report.undecided_by)
    };
    places.map(ask).into()
}

#[test]
fn what_is_near_may_be_free_before_a_background_with_noise_of_metres() {
    for wall in [6.0, 10.0, 15.0] {
        let settings = CloudSettings::new(STEREO);
        let cloud = Cloud::prepare(&over_a_table(wall), &settings).unwrap();
        let answers = of_a_box_in_the_air(&cloud);
        assert!(
            answers.iter().all(|(verdict, _)| *verdict == Verdict::Free),
            "{wall}: {answers:?}"
        );
    }
}

#[test]
fn returns_left_out_for_their_range_say_that_there_is_nothing_before() {
    for wall in [6.0, 10.0, 15.0] {
        let filter = FilterSettings { max_range: 4.0, ..FilterSettings::for_sensor(&STEREO) };
        let settings = CloudSettings { filter, ..CloudSettings::new(STEREO) };
        let cloud = Cloud::prepare(&over_a_table(wall), &settings).unwrap();
        let answers = of_a_box_in_the_air(&cloud);
        assert!(
            answers.iter().all(|(verdict, _)| *verdict == Verdict::Free),
            "{wall}: {answers:?}"
        );
        // Past the range nothing is known.
        let held = mesh(&scene::cuboid([0.1; 3]));
        let far = Pose::from_translation(Vector3::new(0.0, -0.3, 4.3));
        let report = query(Mode::Calibrated).run(&cloud, &held, &far).unwrap();
        assert_eq!(report.undecided_by, Some(Undecided::Unseen), "{report:?}");
        let unseen = report.unseen.unwrap();
        assert!(unseen.out_of_range > 0.9, "{unseen:?}");
    }
}

/// The slip that the doubt is for: noise stated in another unit is too large everywhere.
#[test]
fn noise_in_another_unit_is_still_doubted() {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.4 });
    let cloud = Cloud::prepare(&over_a_table(3.0), &settings).unwrap();
    let answers = of_a_box_in_the_air(&cloud);
    let is_doubted = |(verdict, by): &(Verdict, Option<Undecided>)| {
        *verdict != Verdict::Free && by.is_none_or(|by| by == Undecided::Noise)
    };
    assert!(answers.iter().all(is_doubted), "{answers:?}");
}
