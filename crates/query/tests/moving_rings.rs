//! A map that a laser scanner keeps up to date as it moves.

use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::{Neighborhoods, SensorModel};
use cloudtouch::{Cloud, CloudSettings};

/// A scanner with few rings that creeps over a floor: each ring took for measured again what the ring before it had
/// measured up to the mean of the steps along and across rings aside, and floor that was swept over was lost.
#[test]
fn rings_that_move_on_leave_what_they_measured() {
    let lidar = SensorModel::Lidar { range_std: 0.01, beam_rad: 0.003 };
    let settings = CloudSettings::new(lidar);
    let (rings, steps) = (16, 720);
    let frame = |index: usize| {
        let scanner = Vector3::new(-1.0 + 0.05 * index as f64, 0.0, 1.5);
        let seen = |i: usize| {
            let up = f64::to_radians(-15.0 + 2.0 * (i / steps) as f64);
            let round = std::f64::consts::TAU * (i % steps) as f64 / steps as f64;
            let ray = Vector3::new(up.cos() * round.cos(), up.cos() * round.sin(), up.sin());
            let wall = (0..2).map(|k| (9.0 - scanner[k] * ray[k].signum()) / ray[k].abs());
            let floor = if ray.z < 0.0 { scanner.z / -ray.z } else { f64::INFINITY };
            Point3::from(scanner + ray * wall.fold(floor, f64::min))
        };
        let points = (0..rings * steps).map(seen).collect();
        let sensor_pose = Some(Pose::from_translation(scanner));
        let image_size = Some((steps, rings));
        PointCloud { sensor_pose, image_size, ..PointCloud::from_points(points) }
    };
    let mut map = Cloud::prepare(&frame(0), &settings).unwrap();
    let mut measured = frame(0).points;
    for index in 1..8 {
        map.replace_frame(&frame(index), &settings).unwrap();
        measured.extend(frame(index).points);
    }
    let kept =
        Neighborhoods::new((0..map.len()).map(|i| map.point(i)).collect::<Vec<_>>()).unwrap();
    let floor: Vec<&Point3> = measured.iter().filter(|p| p.z.abs() < 1e-6).collect();
    let is_lost = |p: &&&Point3| kept.nearest_to(p, 1)[0].squared_distance > 0.01;
    let lost = floor.iter().filter(is_lost).count();
    assert!(floor.len() > 20_000 && lost < floor.len() / 100, "{lost} of {}", floor.len());
}
