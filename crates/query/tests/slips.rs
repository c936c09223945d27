//! Slips of someone in a hurry: what cannot be meant does not read as free, and the report says why.

use crate::common::{AnyQuery, MODES, Scan, ask, at, measured, mesh, uniform};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, FilterSettings, Mesh, Mode, PaperCloud, PaperCloudSettings, Path,
    PrepareError, Query, QuerySettings, Report, Safeguards, SelfMesh, Undecided, Verdict, Warning,
    Which,
};
use cloudtouch_testkit::scene;
use std::sync::Arc;

pub(crate) const NOISE: SensorModel = SensorModel::Isotropic { std: 0.002 };

/// A table of 1 m, its top at z = 0, one point in each square of 2 cm.
pub(crate) fn table() -> PointCloud {
    PointCloud::from_points(measured(&scene::plane_patch(1.0), 0.02, 0.002, 1))
}

pub(crate) fn tool() -> TriangleMesh {
    scene::cuboid([0.1, 0.1, 0.2])
}

fn scaled(cloud: &PointCloud, factor: f64) -> PointCloud {
    let points = cloud.points.iter().map(|p| Point3::from(p.coords * factor)).collect();
    PointCloud { points, ..cloud.clone() }
}

pub(crate) fn scan(cloud: &PointCloud, mode: Mode) -> Scan {
    Scan::of(cloud, NOISE, mode).expect("a good cloud")
}

/// Both paths say that they cannot tell, for this reason and with a warning of it.
pub(crate) fn check(
    cloud: impl Fn(Mode) -> Scan,
    object: &Mesh,
    pose: &Pose,
    reason: Undecided,
    is_told: impl Fn(&Warning) -> bool,
) {
    for mode in MODES {
        let report = ask(mode, &cloud(mode), object, pose);
        assert_eq!(report.verdict, Verdict::Undecided, "{mode:?}: {report:?}");
        assert_eq!((report.undecided_by, report.bounds[1]), (Some(reason), 1.0), "{report:?}");
        assert!(report.warnings.iter().any(&is_told), "{report:?}");
        let words: Vec<String> = report.warnings.iter().map(Warning::to_string).collect();
        assert!(words.iter().all(|w| !w.contains("NaN") && w.contains(' ')), "{words:?}");
    }
}

#[test]
fn what_is_meant_is_free_without_a_warning() {
    for mode in MODES {
        let report = ask(mode, &scan(&table(), mode), &mesh(&tool()), &at(0.1, 0.2, 0.2));
        assert_eq!((report.collision_probability < 0.1, report.warnings.len()), (true, 0));
        if mode == Mode::Calibrated {
            assert_eq!(report.verdict, Verdict::Free, "{report:?}");
        }
    }
}

#[test]
fn a_cloud_in_millimetres_read_free() {
    let in_mm = |mode| scan(&scaled(&table(), 1000.0), mode);
    let told = |w: &Warning| matches!(w, Warning::Sparse { .. } | Warning::Units { .. });
    check(in_mm, &mesh(&tool()), &at(0.1, 0.2, 0.3), Undecided::Units, told);
}

#[test]
fn a_mesh_in_millimetres_read_free() {
    let in_mm = mesh(&tool().scaled(1000.0));
    let told = |w: &Warning| matches!(w, Warning::Units { size_m, .. } if *size_m > 200.0);
    check(|mode| scan(&table(), mode), &in_mm, &at(0.1, 0.2, 150.0), Undecided::Units, told);
}

/// A tool of a few centimetres in inches is no larger than what is moved elsewhere: it is told only.
#[test]
fn an_object_larger_than_its_scene_read_free_in_silence() {
    let told = |w: &Warning| matches!(w, Warning::Exchanged { .. });
    for (scale, undecided) in [(4.0, None), (130.0, Some(Undecided::Units))] {
        let larger = mesh(&scene::cuboid([scale; 3]));
        let report = ask(
            Mode::Calibrated,
            &scan(&table(), Mode::Calibrated),
            &larger,
            &at(0.0, 0.0, 0.6 * scale),
        );
        assert!(report.warnings.iter().any(told), "{report:?}");
        assert_eq!(report.undecided_by, undecided, "{report:?}");
    }
}

/// Sizes that fit each other say nothing of their unit.
#[test]
fn both_files_and_the_pose_in_millimetres_read_free() {
    let in_mm = |mode| scan(&scaled(&table(), 1000.0), mode);
    let told = |w: &Warning| matches!(w, Warning::Units { body: Which::B, .. });
    let tool = mesh(&tool().scaled(1000.0));
    check(in_mm, &tool, &at(100.0, 200.0, 300.0), Undecided::Units, told);
}

#[test]
fn a_pose_in_millimetres_read_free() {
    let told = |w: &Warning| matches!(w, Warning::FarAway { .. });
    let in_mm = at(100.0, 200.0, 300.0);
    check(|mode| scan(&table(), mode), &mesh(&tool()), &in_mm, Undecided::Units, told);
    // In metres 6 cm above it, and 25 mm.
    for just_above in [60.0, 25.0] {
        let just_above = at(0.0, 0.0, just_above);
        check(|mode| scan(&table(), mode), &mesh(&tool()), &just_above, Undecided::Units, told);
    }
    // Two metres beside the table nothing is in the way, and the report says so.
    let beside = ask(
        Mode::Calibrated,
        &scan(&table(), Mode::Calibrated),
        &mesh(&tool()),
        &at(2.5, 0.0, 0.0),
    );
    assert_eq!(beside.verdict, Verdict::Free, "{beside:?}");
    assert!(matches!(beside.warnings[..], [Warning::OutsideScene { gap_m, .. }] if gap_m > 1.8));
}

#[test]
fn units_that_are_meant_all_the_same_are_believed() {
    let safeguards = Safeguards { doubt_units: false, ..Safeguards::default() };
    let query = AnyQuery::with(Mode::Calibrated, |by| by.safeguards = safeguards, |_| {});
    let scene = scan(&table(), Mode::Calibrated);
    let far = query.run(&scene, &mesh(&tool()), &at(100.0, 200.0, 300.0)).expect("a good pose");
    assert_eq!((far.verdict, far.warnings.len()), (Verdict::Free, 1));
}

/// Every pose was uncertain, and nothing said why.
#[test]
fn a_threshold_below_every_answer_is_told() {
    let (scene, tool) = (scan(&table(), Mode::Calibrated), mesh(&tool()));
    let with = |reject| AnyQuery::with(Mode::Calibrated, |by| by.reject = reject, |_| {});
    let ask = |reject, z| with(reject).run(&scene, &tool, &at(0.0, 0.0, z)).expect("a good pose");
    let told = ask(1e-6, 0.3);
    assert_eq!(told.verdict, Verdict::Uncertain, "{told:?}");
    let [Warning::RejectBelowLeast { reject, least }] = told.warnings[..] else {
        panic!("{told:?}");
    };
    assert_eq!((reject, least), (1e-6, told.collision_probability));
    let free = ask(1.5 * least, 0.3);
    assert_eq!((free.verdict, &free.warnings[..]), (Verdict::Free, &[][..]));
    // What is near may be uncertain for its own sake.
    assert_eq!(ask(1e-6, 0.0).warnings, []);
}

/// A padding in centimetres took the table away, and nothing was in the way any more.
#[test]
fn a_scan_that_the_self_filter_took_away_read_free() {
    let with_padding = |padding, mode| {
        let link = Arc::new(mesh(&tool()));
        let cloud_from_link = at(0.1, 0.1, 0.3);
        let robot = vec![SelfMesh { mesh: link, cloud_from_link, padding }];
        let filter = FilterSettings { robot, ..FilterSettings::default() };
        match mode {
            Mode::Calibrated => {
                let settings = CloudSettings { filter, ..CloudSettings::new(NOISE) };
                Scan::Calibrated(Cloud::prepare(&table(), &settings).expect("points are left"))
            }
            Mode::Paper => {
                let settings = PaperCloudSettings { filter, ..PaperCloudSettings::amended(NOISE) };
                Scan::Paper(PaperCloud::prepare(&table(), &settings).expect("points are left"))
            }
        }
    };
    let told = |w: &Warning| matches!(w, Warning::SelfFilter { share, .. } if *share > 0.5);
    let within = at(0.1, 0.1, 0.0);
    let padded = |mode| with_padding(0.6, mode);
    check(padded, &mesh(&tool()), &within, Undecided::Missing, told);
    let right = with_padding(0.02, Mode::Calibrated);
    let collides = ask(Mode::Calibrated, &right, &mesh(&tool()), &within);
    assert_eq!(collides.verdict, Verdict::InCollision);
    assert!(matches!(collides.warnings[..], [Warning::NoRobot { .. }]), "{collides:?}");
}

/// A padding of 10 cm took what lay beside the gripper out of the scan, and said how many points only.
#[test]
fn a_padding_that_takes_more_than_the_robot_is_told() {
    let link = Arc::new(mesh(&tool()));
    for (padding, is_told) in [(0.02, false), (0.15, true)] {
        let cloud_from_link = at(0.1, 0.1, 0.1);
        let robot = vec![SelfMesh { mesh: link.clone(), cloud_from_link, padding }];
        let filter = FilterSettings { robot, ..FilterSettings::default() };
        let settings = CloudSettings { filter, ..CloudSettings::new(NOISE) };
        let scan = Scan::Calibrated(Cloud::prepare(&table(), &settings).expect("points are left"));
        let report = ask(Mode::Calibrated, &scan, &mesh(&tool()), &at(0.1, 0.1, 0.5));
        let told = |w: &Warning| matches!(w, Warning::Padding { share, .. } if *share > 0.5);
        assert_eq!(report.warnings.iter().any(told), is_told, "{padding}: {report:?}");
    }
}

#[test]
fn points_that_span_no_surface_read_free() {
    let told = |w: &Warning| matches!(w, Warning::NoSurface { .. });
    let line = (0..200).map(|i| Point3::new(0.01 * f64::from(i) - 1.0, 0.3, 0.1)).collect();
    let same = vec![Point3::new(0.1, 0.2, 0.0); 50];
    for points in [vec![Point3::new(0.1, 0.2, 0.0)], same, line] {
        let cloud = PointCloud::from_points(points);
        check(
            |mode| scan(&cloud, mode),
            &mesh(&tool()),
            &at(0.0, 0.0, 0.5),
            Undecided::NoSurface,
            told,
        );
    }
}

#[test]
fn a_cloud_with_every_third_row_missing_read_free() {
    let mut cloud = table();
    cloud.points.iter_mut().step_by(3).for_each(|p| p.x = f64::NAN);
    let told = |w: &Warning| matches!(w, Warning::Missing { share, .. } if *share > 0.3);
    check(|mode| scan(&cloud, mode), &mesh(&tool()), &at(0.1, 0.2, 0.3), Undecided::Missing, told);
}

/// As some drivers write them.
#[test]
fn missing_rows_of_zeros_read_free() {
    let mut cloud = table();
    cloud.points.iter_mut().step_by(3).for_each(|p| *p = Point3::origin());
    let told = |w: &Warning| matches!(w, Warning::Missing { share, .. } if *share > 0.3);
    check(|mode| scan(&cloud, mode), &mesh(&tool()), &at(0.1, 0.2, 0.3), Undecided::Missing, told);
    // One row there may be a point, and so may two.
    let mut cloud = table();
    cloud.points[..2].fill(Point3::origin());
    assert_eq!(scan(&cloud, Mode::Calibrated).len(), table().len() - 1);
}

#[test]
fn noise_in_millimetres_was_taken_for_metres() {
    for mode in MODES {
        let error = Scan::of(&table(), SensorModel::Isotropic { std: 5.0 }, mode).unwrap_err();
        assert!(matches!(error, PrepareError::NoiseBeyondSize { std: 5.0, .. }), "{error}");
        assert!(error.to_string().contains("metres"), "{error}");
    }
    // Half a metre is less than the table, and more than the tool.
    let told = |w: &Warning| matches!(w, Warning::Noise { std_m, .. } if *std_m == 0.5);
    let noisy = |mode| {
        Scan::of(&table(), SensorModel::Isotropic { std: 0.5 }, mode).expect("a noisy cloud")
    };
    for mode in MODES {
        let report = ask(mode, &noisy(mode), &mesh(&tool()), &at(0.1, 0.2, 0.8));
        assert_ne!(report.verdict, Verdict::Free, "{mode:?}: {report:?}");
        assert!(report.warnings.iter().any(told), "{report:?}");
    }
}

/// Noise said in millimetres, or a hundred times what it is, made everything nearby free: a surface known to
/// half a metre may well be elsewhere.
#[test]
fn noise_that_points_do_not_have_read_free() {
    for std in [0.03, 0.2] {
        let sensor = SensorModel::Isotropic { std };
        let overstated = |mode| Scan::of(&table(), sensor, mode).expect("a good cloud");
        // 3 cm of overlap.
        let report = ask(
            Mode::Calibrated,
            &overstated(Mode::Calibrated),
            &mesh(&tool()),
            &at(0.1, 0.2, 0.07),
        );
        let is_told =
            |w: &Warning| matches!(w, Warning::NoiseOverstated { std_m, .. } if *std_m > 0.9 * std);
        assert!(report.warnings.iter().any(is_told), "{report:?}");
        assert_ne!(report.verdict, Verdict::Free, "{report:?}");
    }
    // Where not even so much noise brings them together, free is free.
    let overstated = Scan::of(&table(), SensorModel::Isotropic { std: 0.03 }, Mode::Calibrated);
    let far = ask(
        Mode::Calibrated,
        &overstated.expect("a good cloud"),
        &mesh(&tool()),
        &at(0.1, 0.2, 0.4),
    );
    assert_eq!(far.verdict, Verdict::Free, "{far:?}");
}

/// A path was undecided all along, whose every pose was free.
#[test]
fn a_path_far_from_noise_that_points_do_not_have_is_free() {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.03 });
    let table = Cloud::prepare(&table(), &settings).expect("a good cloud");
    let query = Query::new(QuerySettings::default()).expect("default settings");
    let swept = |height: f64| {
        let path = Path::linear(&at(0.0, 0.0, height), &at(0.2, 0.1, height)).expect("two poses");
        query.sweep(&table, &mesh(&tool()), &path, 0.01).expect("good poses")
    };
    assert_eq!(swept(0.5).verdict, Verdict::Free);
    let near = swept(0.11);
    assert_ne!(near.verdict, Verdict::Free, "{near:?}");
}

/// The pose leads the wrong way then, and a gripper in the wall read free.
#[test]
fn a_scan_given_as_the_object_was_not_wondered_at() {
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let scan = Cloud::prepare(&table(), &CloudSettings::new(NOISE)).expect("points are left");
    let tool = mesh(&tool());
    let is_told = |report: &Report| {
        report
            .warnings
            .iter()
            .any(|w| matches!(w, Warning::Exchanged { size_m, .. } if *size_m > 1.4))
    };
    let into = at(0.1, 0.2, 0.05);
    assert!(!is_told(&query.run(&scan, &tool, &into).expect("a good pose")));
    let exchanged = query.run(&tool, &scan, &into).expect("a good pose");
    assert!(is_told(&exchanged), "{exchanged:?}");
    // Of two meshes either may be the scene.
    let table = mesh(&scene::plane_patch(1.0));
    assert!(!is_told(&query.run(&tool, &table, &into).expect("a good pose")));
}

/// The samples of a mesh are as far apart as those of the cloud, and one point is none apart: the classifier was asked
/// or not by how the place of contact was rounded, so that a probability was .18 one way round and .50 the other, and
/// sometimes there was no answer, for "a spacing of 0 m takes more than 20000 triangles".
#[test]
fn a_single_point_beside_a_mesh_is_told_alike_whichever_comes_first() {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.012 });
    let one = Cloud::prepare(&PointCloud::from_points(vec![Point3::origin()]), &settings)
        .expect("a point");
    let cube = Mesh::prepare(&scene::cuboid([0.1; 3])).expect("a mesh");
    let query = Query::new(QuerySettings::default()).expect("good settings");
    for k in 0..2000 {
        let unit = |n: u64| 2.0 * uniform(k, n) - 1.0;
        let offset = Vector3::new(unit(0), unit(1), unit(2)) * 0.08;
        let pose = Pose::from_translation_rpy(offset, [3.0 * unit(3), unit(4), 3.0 * unit(5)]);
        let told = query.run(&cube, &one, &pose).expect("an answer");
        let turned = query.run(&one, &cube, &pose.inverse()).expect("an answer");
        let apart = (told.collision_probability - turned.collision_probability).abs();
        assert!(apart < 1e-3 && told.verdict != Verdict::Free, "{k}: {told:?} {turned:?}");
    }
}
