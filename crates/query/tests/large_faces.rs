//! Faces along one another: the least of the distances between hundreds of noisy pieces says little.

use crate::common::{assert_sound, at, measured, mesh};
use cloudtouch::geom::{Point3, PointCloud};
use cloudtouch::noise::SensorModel;
use cloudtouch::{BodyRef, Cloud, CloudSettings, Judge, Query, QuerySettings, Report, Verdict};
use cloudtouch_testkit::scene;

/// Draws of the noise.
const DRAWS: u64 = 12;
const STD: f64 = 0.005;
const SPACING: f64 = 0.008;

fn scan(size: [f64; 3], seed: u64) -> Cloud {
    let points = measured(&scene::cuboid(size), SPACING, STD, seed);
    let settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
    Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
}

/// The mean probability of a box so far above a table, m, as a scan and as a mesh.
fn mean(judge: Judge, gap: f64) -> [f64; 2] {
    let query = Query::new(QuerySettings { judge, ..QuerySettings::default() }).expect("settings");
    let solid = mesh(&scene::cuboid([0.16, 0.12, 0.1]));
    let pose = at(0.03, -0.02, 0.02 + 0.05 + gap);
    let mut sums = [0.0; 2];
    for seed in 0..DRAWS {
        let (table, carton) = (scan([0.5, 0.4, 0.04], seed), scan([0.16, 0.12, 0.1], !seed));
        let bodies = [BodyRef::from(&carton), BodyRef::from(&solid)];
        for (sum, body) in sums.iter_mut().zip(bodies) {
            let report: Report = query.run(&table, body, &pose).expect("a good pose");
            assert_sound(&report);
            // What is pressed in by the noise is never free.
            assert!(gap > -STD || report.verdict != Verdict::Free, "{gap}: {report:?}");
            *sum += report.collision_probability / DRAWS as f64;
        }
    }
    sums
}

/// By the place alone .60 and .39.
#[test]
fn a_box_flat_over_a_table_read_as_touching() {
    let [by_scan, by_mesh] = mean(Judge::default(), 0.008);
    assert!(by_scan < 0.25 && by_mesh < 0.35, "{by_scan} {by_mesh}");
    let by_place = mean(Judge::default().without_extent(), 0.008);
    assert!(by_place[0] > by_scan + 0.2, "{by_place:?}: the extent says nothing");
}

#[test]
fn a_box_pressed_into_a_table_by_its_noise_is_told() {
    for p in mean(Judge::default(), -STD) {
        assert!(p > 0.85, "{p}");
    }
}

/// Samples at one place are as near as can be, however many they are: they were counted as faces apart.
#[test]
fn a_face_on_itself_read_free() {
    let points =
        (0..400).map(|i| Point3::new(0.01 * f64::from(i % 20), 0.01 * f64::from(i / 20), 0.0));
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    let sheet =
        Cloud::prepare(&PointCloud::from_points(points.collect()), &settings).expect("a sheet");
    let query = Query::new(QuerySettings::default()).expect("settings");
    let report = query.run(&sheet, &sheet, &at(0.0, 0.0, 0.0)).expect("a good pose");
    assert_eq!(report.evidence.and_then(|evidence| evidence.extent), Some(0.0));
    assert_ne!(report.verdict, Verdict::Free, "{report:?}");
}

/// Samples at the rim of its bottom, and of its walls beside that, were as likely below it as their noise and
/// the discs about them: 4.6 mm was told, of 10.
#[test]
fn a_box_over_a_table_was_told_as_near_as_the_samples_at_its_rim() {
    const GAP: f64 = 0.01;
    let query = Query::new(QuerySettings::default()).expect("settings");
    let table = mesh(&scene::cuboid([0.5, 0.4, 0.04]));
    let pose = at(0.03, -0.02, -(0.02 + 0.05 + GAP));
    let told = |seed: u64| {
        let points = measured(&scene::cuboid([0.12, 0.08, 0.1]), 0.005, 0.002, seed);
        let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
        let carton = Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a cloud");
        let report = query.run(&carton, &table, &pose).expect("a good pose");
        assert_sound(&report);
        report.clearance_m.expect("a gap").mean
    };
    let mean = (0..DRAWS).map(told).sum::<f64>() / DRAWS as f64;
    assert!((0.0053..GAP).contains(&mean), "{mean}");
}

/// One in some thousand samples is 3.5 deviations off: beneath a large plate there is mostly one, and it stayed where it
/// was measured if the noise was less than a quarter of the spacing. Half of these draws were `uncertain`.
#[test]
fn a_sample_far_off_a_sharp_table_stopped_a_plate_over_it() {
    const DRAWS: u64 = 24;
    const STD: f64 = 0.0004;
    let query = Query::new(QuerySettings::default()).expect("settings");
    let plate = mesh(&scene::cuboid([0.15, 0.15, 0.03]));
    let settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
    let is_free = |seed: u64, deviations: f64| {
        let points = measured(&scene::cuboid([0.2, 0.2, 0.04]), 0.004, STD, seed);
        let table = Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a cloud");
        let pose = at(0.0, 0.0, 0.02 + 0.015 + deviations * STD);
        let report = query.run(&table, &plate, &pose).expect("a good pose");
        assert_sound(&report);
        report.verdict == Verdict::Free
    };
    let free = (0..DRAWS).filter(|&seed| is_free(seed, 5.0)).count();
    assert!(free >= 20, "{free} of {DRAWS}");
    assert!((0..DRAWS).all(|seed| !is_free(seed, -1.0)), "pressed in by its noise");
}
