//! Units do not matter: coordinates, covariances and pose in millimetres or kilometres give the
//! same probability.

use crate::common::{AnyQuery, MODES, Scan, ask, measured, mesh, prepare_each};
use cloudtouch::geom::{Covariance, Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mode, Query, QuerySettings, Report, Undecided};
use cloudtouch_testkit::scene;

const STD: f64 = 0.003;

fn scaled(points: &[Point3], factor: f64, mode: Mode) -> Scan {
    let covariance = Covariance::isotropic(STD * STD).scaled(factor);
    let points: Vec<Point3> = points.iter().map(|p| p * factor).collect();
    let count = points.len();
    prepare_each(points, vec![covariance; count], mode)
}

fn pose(gap: f64, factor: f64) -> Pose {
    let offset = Vector3::new(0.02, 0.01, 0.1 + gap) * factor;
    Pose::from_translation_rpy(offset, [0.3, 0.2, -1.0])
}

fn same(small: &Report, large: &Report, factor: f64, about: impl std::fmt::Debug) {
    let (p, q) = (small.collision_probability, large.collision_probability);
    // The solver's tolerance: rounding takes another path through the same problem.
    assert!((p - q).abs() < 1e-3, "{about:?}: {p} and {q}");
    assert_eq!(small.verdict, large.verdict, "{about:?}");
    // A clearance belongs to the most probable place. Near 0 and 1 many places are equally probable,
    // and in the paper's mode a random descent may find another.
    let one_place = small.mode == Mode::Calibrated && (0.01..0.99).contains(&p);
    if let (true, Some(s), Some(l)) = (one_place, small.clearance_m, large.clearance_m) {
        // A tenth of the noise, since another point may be foremost.
        assert!((s.mean - l.mean / factor).abs() < 0.1 * STD, "{about:?}: {s:?}, {l:?}");
    }
}

#[test]
fn two_clouds() {
    let floor = measured(&scene::plane_patch(0.4), 0.02, STD, 1);
    let ball = measured(&scene::sphere(0.1, 3), 0.016, STD, 2);
    for mode in MODES {
        for gap in [-0.02, 0.0, 0.008, 0.015, 0.04] {
            let at = |factor: f64| {
                let (a, b) = (scaled(&floor, factor, mode), scaled(&ball, factor, mode));
                ask(mode, &a, &b, &pose(gap, factor))
            };
            let unit = at(1.0);
            for factor in [1e-3, 1e3] {
                same(&unit, &at(factor), factor, (mode, gap, factor));
            }
        }
    }
}

fn cloud_and_mesh(mode: Mode, gap: f64, factor: f64) -> Report {
    let floor = measured(&scene::plane_patch(0.4), 0.02, STD, 1);
    let ball = mesh(&scene::sphere(0.1, 3).scaled(factor));
    // An object of 200 m is doubted for its unit.
    let query = AnyQuery::with(
        mode,
        |by_default| by_default.safeguards.doubt_units = false,
        |of_paper| of_paper.safeguards.doubt_units = false,
    );
    let floor = scaled(&floor, factor, mode);
    query.run(&floor, &ball, &pose(gap, factor)).expect("a good pose")
}

#[test]
fn a_cloud_and_a_mesh() {
    for gap in [-0.02, 0.0, 0.004, 0.008, 0.015, 0.04] {
        let unit = cloud_and_mesh(Mode::Calibrated, gap, 1.0);
        for factor in [1e-3, 1e3] {
            let other = cloud_and_mesh(Mode::Calibrated, gap, factor);
            same(&unit, &other, factor, (gap, factor));
        }
    }
}

/// The paper's mode samples the mesh afresh for each leaf, and draws which pairs it looks at: there
/// rounding can decide what is looked at. Powers of two round nothing, so that any difference would
/// come from a constant in metres.
#[test]
fn a_cloud_and_a_mesh_in_the_papers_mode() {
    for gap in [-0.02, 0.0, 0.004, 0.008, 0.015, 0.04] {
        let unit = cloud_and_mesh(Mode::Paper, gap, 1.0);
        for factor in [1.0 / 1024.0, 1024.0] {
            let other = cloud_and_mesh(Mode::Paper, gap, factor);
            let (p, q) = (unit.collision_probability, other.collision_probability);
            // Square roots and exponentials of scaled numbers round as those of the numbers do.
            assert!((p - q).abs() < 1e-9, "gap {gap}, factor {factor}: {p} and {q}");
            assert_eq!(unit.verdict, other.verdict, "gap {gap}, factor {factor}");
        }
    }
}

/// The box of a body that was turned in its file is wider, and what fits between points was told not to.
#[test]
fn what_fits_between_the_points_of_a_cloud_does_whichever_way_its_file_is_turned() {
    let turn = |angles: [f64; 3]| Pose::from_translation_rpy(Vector3::zeros(), angles);
    let points: Vec<Point3> = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.5, 0.45]]
        .map(|[x, y]| Point3::new(x - 0.5, y - 0.5, 0.0))
        .into();
    let cloud = PointCloud::from_points(points);
    let cloud = Cloud::prepare(&cloud, &CloudSettings::new(SensorModel::Exact)).unwrap();
    let query = Query::new(QuerySettings::default()).unwrap();
    for angles in [[0.0; 3], [0.785, 0.615, 0.0], [0.3, 1.0, 2.0]] {
        let cube = scene::moved(&scene::cuboid([0.3; 3]), &turn(angles));
        let place = Pose::from_translation(Vector3::new(0.0, 0.3, 0.25));
        let pose = place.after(&turn(angles).inverse());
        let report = query.run(&cloud, &mesh(&cube), &pose).unwrap();
        assert_eq!(report.undecided_by, Some(Undecided::Sparse), "{angles:?}");
    }
}
