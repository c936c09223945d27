//! A laser panorama is believed where its scanner stood, and nowhere else.

use std::f64::consts::TAU;

use crate::common::{mesh, query};
use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mode, Undecided, Verdict};
use cloudtouch_testkit::scene;

const SCANNER: Vector3 = Vector3::new(3.0, -1.0, 1.2);

/// Rings of 16 lasers in a room of 8 m by 6 m by 3 m with a pillar, moved to where the scanner stood.
fn panorama() -> PointCloud {
    let (beams, steps) = (48, 720);
    let seen = |i: usize| {
        let up = -0.6 + 1.2 * (i / steps) as f64 / beams as f64;
        let round = TAU * (i % steps) as f64 / steps as f64;
        let ray = Vector3::new(up.cos() * round.cos(), up.cos() * round.sin(), up.sin());
        let wall = (0..3).map(|k| [4.0, 3.0, 1.5][k] / ray[k].abs()).fold(f64::INFINITY, f64::min);
        let is_pillar = (round - 0.4).abs() < 0.2;
        let range = if is_pillar { wall.min(1.2 / ray.xy().norm()) } else { wall };
        Point3::from(SCANNER + ray * range)
    };
    let points = (0..beams * steps).map(seen).collect();
    PointCloud { image_size: Some((steps, beams)), ..PointCloud::from_points(points) }
}

/// What is answered of a box of 20 cm in the air beside the pillar.
fn answer(scan: &PointCloud, sensor: SensorModel) -> (Verdict, Option<Undecided>) {
    let cloud = Cloud::prepare(scan, &CloudSettings::new(sensor)).expect("a good cloud");
    let held = mesh(&scene::cuboid([0.2; 3]));
    let pose = Pose::from_translation(SCANNER + Vector3::new(-1.0, 0.8, 0.2));
    let report = query(Mode::Calibrated).run(&cloud, &held, &pose).expect("good bodies");
    (report.verdict, report.undecided_by)
}

#[test]
fn a_panorama_in_another_frame_is_not_believed_without_its_place() {
    let elsewhere = panorama();
    let there = Some(Pose::from_translation(SCANNER));
    let placed = PointCloud { sensor_pose: there, ..elsewhere.clone() };
    let lidar = SensorModel::Lidar { range_std: 0.01, beam_rad: 0.001 };
    for sensor in [lidar, SensorModel::Isotropic { std: 0.01 }] {
        let doubted = (Verdict::Undecided, Some(Undecided::Sensor));
        assert_eq!(answer(&elsewhere, sensor), doubted, "{sensor:?}");
        assert_eq!(answer(&placed, sensor), (Verdict::Free, None), "{sensor:?}");
    }
}
