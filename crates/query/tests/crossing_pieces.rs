//! Exact and thin things: what meets between samples, and what is at one place.

use crate::common::{assert_sound, at, measured, mesh};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, Mesh, Mode, Query, QuerySettings, Report, Undecided, Verdict,
};
use cloudtouch_testkit::scene;

fn ask<'a>(
    a: impl Into<cloudtouch::BodyRef<'a>>,
    b: impl Into<cloudtouch::BodyRef<'a>>,
    pose: &Pose,
) -> Report {
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let report = query.run(a, b, pose).expect("a good pose");
    assert_sound(&report);
    report
}

fn cloud(points: Vec<Point3>, std: f64) -> Cloud {
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
}

/// Samples on a lattice of 2 cm, so that places between them are known.
fn table() -> Vec<Point3> {
    let at = |i: i32| 0.02 * f64::from(i);
    (-15..=15).flat_map(|i| (-15..=15).map(move |j| Point3::new(at(i), at(j), 0.0))).collect()
}

#[test]
fn one_exact_point_on_itself_read_free() {
    let point = cloud(vec![Point3::origin()], 0.0);
    let report = ask(&point, &point, &Pose::identity());
    assert_ne!(report.verdict, Verdict::Free, "{report:?}");
    let apart = ask(&point, &point, &at(0.001, 0.0, 0.0));
    // One point tells of no surface: it is not near, and no more is known.
    assert!(apart.collision_probability < 0.01, "{apart:?}");
    assert_eq!(apart.undecided_by, Some(Undecided::NoSurface), "{apart:?}");
}

/// Between four samples, as far from all of them as can be.
#[test]
fn a_rod_through_a_table_between_its_samples_read_as_beside_it() {
    let rod: Mesh = mesh(&scene::cuboid([0.004, 0.004, 0.3]));
    for std in [0.0, 0.001] {
        let table = cloud(table(), std);
        for (x, y) in [(0.01, 0.01), (0.05, 0.03), (0.013, 0.006)] {
            let through = ask(&table, &rod, &at(x, y, 0.02));
            assert!(through.collision_probability > 0.4, "{std} {x} {y}: {through:?}");
            assert_ne!(through.verdict, Verdict::Free);
            let above = ask(&table, &rod, &at(x, y, 0.2));
            assert_eq!(above.verdict, Verdict::Free, "{std} {x} {y}: {above:?}");
        }
    }
}

#[test]
fn overlaps_tend_to_certainty_and_gaps_to_nothing() {
    let scan =
        |shape: &TriangleMesh, spacing, seed| cloud(measured(shape, spacing, 0.002, seed), 0.002);
    let ball = scan(&scene::sphere(0.1, 3), 0.012, 1);
    let block = scan(&scene::cuboid([0.3; 3]), 0.012, 2);
    let of = |depth: f64| ask(&block, &ball, &at(0.02, 0.01, 0.25 - depth));
    assert!(of(0.08).collision_probability > 0.99, "{:?}", of(0.08));
    let mut last = 1.0;
    for gap in [0.0, 0.005, 0.01, 0.015, 0.02, 0.03, 0.05, 0.3] {
        let report = of(-gap);
        let p = report.collision_probability;
        assert!(p <= last + 1e-3, "{gap}: {p} after {last}");
        last = p;
    }
    assert!(last < 1e-3, "{last}");
}

/// Two plates 5 mm apart read normals up to 71 degrees off, and a clearance of anything.
#[test]
fn parallel_plates_have_their_normal_and_their_gap() {
    let plate = |seed| cloud(measured(&scene::plane_patch(0.3), 0.016, 0.002, seed), 0.002);
    for seed in 0..6 {
        let (low, high) = (plate(2 * seed), plate(2 * seed + 1));
        let report = ask(&low, &high, &at(0.0, 0.0, 0.005));
        let contact = report.contacts.first().expect("near enough to be told");
        let cosine = contact.normal_a_to_b.z;
        assert!(cosine > 10.0_f64.to_radians().cos(), "{seed}: {contact:?}");
        assert!(contact.probability <= report.collision_probability, "{report:?}");
        let clearance = report.clearance_m.expect("near");
        assert!((clearance.mean - 0.005).abs() < 3.0 * clearance.std, "{seed}: {clearance:?}");
        assert!(report.clearance_at_least_m.is_none_or(|least| least < 0.005), "{report:?}");
    }
}

/// The same leaves or others, with the surface known beforehand or not: the same answer.
#[test]
fn how_the_tree_is_cut_does_not_matter() {
    let points = |shape: &TriangleMesh, seed| measured(shape, 0.012, 0.002, seed);
    let (ball, block) = (points(&scene::sphere(0.1, 3), 1), points(&scene::cuboid([0.3; 3]), 2));
    for depth in [0.02, 0.0, -0.006, -0.02, -0.05] {
        let pose = at(0.02, 0.01, 0.25 - depth);
        let with = |leaf: usize, refined: bool| {
            let prepare = |points: &[Point3]| {
                let mut settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
                settings.tree.max_leaf_points = leaf;
                settings.tree.min_leaf_points = leaf / 2;
                let cloud = PointCloud::from_points(points.to_vec());
                let cloud = Cloud::prepare(&cloud, &settings).expect("a good cloud");
                if refined { cloud.refined().expect("a good cloud") } else { cloud }
            };
            ask(&prepare(&block), &prepare(&ball), &pose).collision_probability
        };
        let usual = with(12, false);
        assert!((with(12, true) - usual).abs() < 1e-6, "{depth}: refined");
    }
}

/// A foot a centimetre above a floor with seven between its samples read "at least 77 mm".
#[test]
fn a_lower_bound_on_the_clearance_forgot_what_was_looked_at() {
    let floor = cloud(measured(&scene::plane_patch(2.0), 0.07, 0.002, 3), 0.002);
    let foot = mesh(&scene::cuboid([0.05, 0.05, 0.3]));
    for x in [0.0, 0.02, 0.04, 0.3] {
        let report = ask(&floor, &foot, &at(x, 0.1, 0.16));
        assert!(report.clearance_at_least_m.is_none_or(|least| least <= 0.011), "{x}: {report:?}");
    }
}

/// What was 5 cm deep in a table read "at least -3 cm": boxes that overlap bound no depth.
#[test]
fn an_overlap_has_no_lower_bound_on_its_clearance() {
    let floor = cloud(measured(&scene::plane_patch(0.6), 0.012, 0.002, 3), 0.002);
    let cup = cloud(measured(&scene::cuboid([0.1; 3]), 0.012, 0.002, 4), 0.002);
    for depth in [0.01, 0.03, 0.06] {
        let report = ask(&floor, &cup, &at(0.0, 0.0, 0.05 - depth));
        assert!(report.collision_probability > 0.9, "{depth}: {report:?}");
        assert_eq!(report.clearance_at_least_m, None, "{depth}");
    }
    let apart = ask(&floor, &cup, &at(0.0, 0.0, 0.35));
    let least = apart.clearance_at_least_m.expect("far apart");
    assert!((0.05..=0.3).contains(&least), "{least}");
}

#[test]
fn both_modes_see_a_mesh_above_a_cloud_as_free() {
    let sheet = mesh(&scene::plane_patch(0.2));
    let floor = cloud(measured(&scene::plane_patch(0.4), 0.02, 0.002, 3), 0.002);
    let report = ask(&floor, &sheet, &at(0.0, 0.0, 0.1));
    assert_eq!((report.verdict, report.mode), (Verdict::Free, Mode::Calibrated));
}
