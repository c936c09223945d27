//! A laser scanner before stairs: between a ring on a riser and the next one on the tread the rim stands out, which none
//! of them met.

use cloudtouch::geom::{Point3, PointCloud, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mode, Verdict};
use cloudtouch_testkit::scene;

use crate::common::{at, mesh, query, uniform};

const RISE: f64 = 0.17;
const GOING: f64 = 0.28;
/// From the scanner to the first riser and down to the floor, m.
const FIRST: f64 = 1.3;
const ABOVE: f64 = 0.75;

/// How far along a ray stairs are that go up along x, m.
fn range(ray: &Vector3) -> f64 {
    let (ahead, up) = (ray.x.max(1e-9), ray.z);
    let floor = if up < 0.0 { -ABOVE / up } else { f64::INFINITY };
    if floor * ahead < FIRST {
        return floor;
    }
    for step in 0..20 {
        let riser = FIRST + GOING * f64::from(step);
        let tread = RISE * f64::from(step + 1) - ABOVE;
        let to_riser = riser / ahead;
        if to_riser * up < tread {
            return to_riser;
        }
        let to_tread = tread / up;
        if up < 0.0 && to_tread * ahead < riser + GOING {
            return to_tread;
        }
    }
    f64::NAN
}

/// What so many rings over 70 degrees measure of them, shifted by a part of what parts these.
fn scan(rings: usize, shift: f64) -> Cloud {
    const STEPS: usize = 400;
    let apart = 70.0 / (rings as f64 - 1.0);
    let place = |i: usize| {
        let up = f64::to_radians(-45.0 + apart * ((i / STEPS) as f64 + shift));
        let round = f64::to_radians(0.35 * ((i % STEPS) as f64 - 200.0));
        let ray = Vector3::new(up.cos() * round.cos(), up.cos() * round.sin(), up.sin());
        Point3::from(ray * range(&ray))
    };
    let points = (0..rings * STEPS).map(place).collect();
    let image = PointCloud {
        sensor_pose: Some(at(0.0, 0.0, 0.0)),
        image_size: Some((STEPS, rings)),
        ..PointCloud::from_points(points)
    };
    let sensor = SensorModel::Lidar { range_std: 0.008, beam_rad: 0.003 };
    Cloud::prepare(&image, &CloudSettings::new(sensor)).expect("a usable scan")
}

/// Of feet so deep in treads, how many are free.
fn free(rings: usize, radius: f64, deep: f64) -> usize {
    let foot = mesh(&scene::sphere(radius, 2));
    let mut free = 0;
    for shift in [0.0, 0.25, 0.5, 0.75] {
        let scan = scan(rings, shift);
        for k in 0..40 {
            let step = (k % 4) as f64;
            let x = FIRST + GOING * step + 0.03 + 0.17 * uniform(k, 0);
            let z = RISE * (step + 1.0) - ABOVE + radius - deep;
            let pose = at(x, 0.8 * (uniform(k, 1) - 0.5), z);
            let report = query(Mode::Calibrated).run(&scan, &foot, &pose).expect("an answer");
            free += usize::from(report.verdict == Verdict::Free);
        }
    }
    free
}

#[test]
fn feet_in_treads_between_two_rings_were_free() {
    for rings in [16, 24, 32, 48, 64, 128] {
        assert_eq!(free(rings, 0.03, 0.025), 0, "{rings} rings");
    }
    for rings in [32, 48, 64, 128] {
        assert_eq!(free(rings, 0.08, 0.025), 0, "{rings} rings, large feet");
    }
    let above = free(128, 0.03, -0.05);
    assert!(above > 100, "{above}");
}

/// Whatever is as small as the gap between two rings may hit something there that no ring met.
#[test]
fn what_fits_between_two_rings_is_not_free() {
    let verdicts = |rings: usize, radius: f64| {
        let scan = scan(rings, 0.0);
        let ball = mesh(&scene::sphere(radius, 2));
        let verdict = |k: u64| {
            let pose = at(0.9, 0.8 * (uniform(k, 0) - 0.5), 0.2 * (uniform(k, 1) - 0.8));
            query(Mode::Calibrated).run(&scan, &ball, &pose).expect("an answer").verdict
        };
        (0..40).filter(|&k| verdict(k) == Verdict::Free).count()
    };
    // Rings are 73 mm apart there, and 9 mm.
    assert_eq!(verdicts(16, 0.03), 0);
    assert_eq!(verdicts(16, 0.06), 40);
    assert_eq!(verdicts(128, 0.03), 40);
}
