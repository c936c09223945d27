//! What is left of changes that mean nothing when problems are solved to 1e-8 is rounding.

use crate::common::{at, measured};
use cloudtouch::geom::{Covariance, Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings};
use cloudtouch_testkit::scene;

/// A scene that is scaled, then moved and turned, with its points in this order.
fn prepared(points: &[Point3], scale: f64, pose: &Pose, backwards: bool) -> Cloud {
    let stds = Vector3::new(0.004, 0.002, 0.002);
    let noise = Covariance::diagonal(stds.map(|std| std * std).into()).scaled(scale);
    let mut points: Vec<Point3> =
        points.iter().map(|p| pose.transform_point(&(p * scale))).collect();
    if backwards {
        points.reverse();
    }
    let covariances = Some(vec![noise.rotated(pose.rotation()); points.len()]);
    let cloud = PointCloud { covariances, ..PointCloud::from_points(points) };
    Cloud::prepare(&cloud, &CloudSettings::new(SensorModel::PerPoint)).expect("finite points")
}

#[test]
fn a_probability_keeps_six_digits_wherever_the_scene_is() {
    let settings = QuerySettings { relative_gap: 1e-8, ..QuerySettings::default() };
    let query = Query::new(settings).unwrap();
    let bodies = [
        measured(&scene::plane_patch(0.3), 0.02, 0.002, 1),
        measured(&scene::sphere(0.08, 3), 0.016, 0.002, 2),
    ];
    let of = |scale: f64, pose: &Pose, backwards: bool| {
        bodies.each_ref().map(|points| prepared(points, scale, pose, backwards))
    };
    let probability =
        |[a, b]: [&Cloud; 2], pose: &Pose| query.run(a, b, pose).unwrap().collision_probability;
    let here = Pose::identity();
    let far = |distance: f64| Pose::from_translation(Vector3::new(0.8, -0.6, 0.1) * distance);
    let turned = Pose::from_translation_rpy(Vector3::zeros(), [0.4, -0.7, 1.9]);
    let still = of(1.0, &here, false);
    let mut between = 0;
    for (scale, motion, backwards) in [
        (1.0, far(1e3), false),
        (1.0, far(1e6), false),
        (1.0, turned, false),
        (1e-6, here, false),
        (1e6, here, false),
        (1.0, here, true),
    ] {
        let [a, b] = of(scale, &motion, backwards);
        for gap in [-0.02, -0.006, -0.003, 0.0, 0.003, 0.006, 0.03] {
            let pose = at(0.01, 0.0, 0.08 + gap);
            let scaled = Pose::from_translation(pose.translation() * scale);
            let before = probability(still.each_ref(), &pose);
            let swapped = probability([&still[1], &still[0]], &pose.inverse());
            let after = probability([&a, &b], &motion.after(&scaled).after(&motion.inverse()));
            for after in [after, swapped] {
                assert!(
                    (before - after).abs() < 1e-6,
                    "{scale}, {motion:?}, {gap}: {before}, {after}"
                );
            }
            between += usize::from((0.01..0.99).contains(&before));
        }
    }
    assert!(between >= 12, "{between}");
}
