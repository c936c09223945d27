//! A few returns far from all others, as stereo cameras deliver where a disparity is near none.

use crate::common::{assert_sound, at, mesh};
use cloudtouch::geom::{Point3, PointCloud, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Report, Verdict};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::scene;

const STEREO: SensorModel =
    SensorModel::Stereo { baseline: 0.1, focal_px: 300.0, disparity_std: 0.08 };

/// A cube of 6 cm so far before a table that a stereo camera looks down on from 1 m, with some of these returns far behind.
fn before_table(gap: f64, strays: &[f64], sensor: SensorModel) -> Report {
    let sample = |i: u32| {
        let [x, y] = [i % 120, i / 120].map(|k| 0.005 * f64::from(k) - 0.3);
        Point3::new(x, y, 1.0)
    };
    let table: Vec<Point3> = (0..120 * 120).map(sample).collect();
    let mut points = add_noise(&table, NoiseKind::Gaussian, 0.0015, 9);
    let along = |(i, &range): (usize, &f64)| {
        Point3::from(Vector3::new(0.01 * i as f64 - 0.2, 0.05, 1.0).normalize() * range)
    };
    points.extend(strays.iter().enumerate().map(along));
    let settings = CloudSettings::new(sensor);
    let scan = Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud");
    let query = Query::new(QuerySettings::default()).expect("settings");
    let cube = mesh(&scene::cuboid([0.06; 3]));
    let report = query.run(&scan, &cube, &at(0.01, 0.02, 1.0 - 0.03 - gap)).expect("a good pose");
    assert_sound(&report);
    report
}

/// One made all `undecided` (`units`), for the scene was as large as it is far away, and its noise of hundreds of metres
/// reached all that is near: P was 1e-4 without it, .14 with one at 300 m.
#[test]
fn one_return_hundreds_of_metres_away_left_nothing_free() {
    let without = before_table(0.04, &[], STEREO);
    assert_eq!(without.verdict, Verdict::Free, "{without:?}");
    for far in [150.0, 300.0, 1000.0] {
        let with = before_table(0.04, &[far], STEREO);
        assert_eq!(with.verdict, Verdict::Free, "{far} m: {:?} {with:?}", with.warnings);
        let [before, now] = [without.collision_probability, with.collision_probability];
        assert!(now < 1.5 * before, "{far} m: {now} for {before}");
        // What is in the way is as before.
        assert_eq!(before_table(-0.01, &[far], STEREO).verdict, Verdict::InCollision);
    }
    let many: Vec<f64> = (0..40).map(|i| 60.0 + 10.0 * f64::from(i)).collect();
    let with = before_table(0.04, &many, STEREO);
    assert_eq!(with.verdict, Verdict::Free, "{:?} {with:?}", with.warnings);
}

/// Of other sensors it stays, and is no reason to doubt the unit of all.
#[test]
fn a_stray_is_no_slip_of_the_unit() {
    for far in [300.0, 1000.0] {
        let report = before_table(0.04, &[far], SensorModel::Isotropic { std: 0.0015 });
        assert_eq!(report.verdict, Verdict::Free, "{far} m: {:?}", report.warnings);
    }
}
