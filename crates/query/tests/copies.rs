//! A scan that was put together with itself, once through single precision.

use crate::common::{assert_sound, at, measured, mesh};
use cloudtouch::geom::{Point3, PointCloud};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings};
use cloudtouch_testkit::scene;

fn prepared(points: Vec<Point3>) -> Cloud {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
}

/// Each of two copies was taken for a sample of its own: P of touching surfaces moved by up to .49, and a pose at .36
/// read `free`.
#[test]
fn copies_that_are_off_by_rounding_counted_as_samples() {
    const AWAY: f64 = 0.7;
    let once = measured(&scene::cuboid([0.4, 0.3, 0.05]), 0.006, 0.002, 3);
    // As a transform in single precision leaves them.
    let rounded = |p: &Point3| p.map(|value| f64::from((value + AWAY) as f32) - AWAY);
    let twice: Vec<Point3> = once.iter().copied().chain(once.iter().map(rounded)).collect();
    let count = once.len();
    let (once, twice) = (prepared(once), prepared(twice));
    assert!(twice.len() <= count && twice.len() + 3 > count, "{} of {count}", twice.len());
    assert!(twice.rows().iter().all(|&row| row < count), "the first of each is kept");
    let query = Query::new(QuerySettings::default()).expect("settings");
    let cube = mesh(&scene::cuboid([0.06; 3]));
    for gap in [-0.004, -0.002, 0.0, 0.002, 0.004, 0.006] {
        let pose = at(0.03, -0.02, 0.025 + 0.03 + gap);
        let [p, q] = [&once, &twice].map(|cloud| {
            let report = query.run(cloud, &cube, &pose).expect("a good pose");
            assert_sound(&report);
            report.collision_probability
        });
        assert!((p - q).abs() < 0.02, "{gap}: {p} {q}");
    }
}
