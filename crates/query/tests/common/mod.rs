//! Clouds of known surfaces, prepared, and what every report has to satisfy.

use cloudtouch::geom::{Covariance, Point3, PointCloud, Pose, TriangleMesh, Vector3, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Mesh, Mode, Report};

mod paths;
pub(crate) mod scenes;

pub(crate) use cloudtouch_testkit::measured::measured;
pub(crate) use paths::{AnyQuery, Asked, MODES, Scan};

/// A pose that only moves.
pub(crate) fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::from_translation(Vector3::new(x, y, z))
}

/// A number in [0, 1) that depends on `stream` and `index` alone.
pub(crate) fn uniform(stream: u64, index: u64) -> f64 {
    seed::unit(seed::derive(stream, index, 0))
}

/// Prepares points with the same noise in every direction.
pub(crate) fn prepare(points: Vec<Point3>, std: f64, mode: Mode) -> Scan {
    let sensor = SensorModel::Isotropic { std };
    Scan::of(&PointCloud::from_points(points), sensor, mode).expect("a good cloud")
}

/// Prepares points that each bring their covariance.
pub(crate) fn prepare_each(points: Vec<Point3>, covariances: Vec<Covariance>, mode: Mode) -> Scan {
    let cloud = PointCloud { covariances: Some(covariances), ..PointCloud::from_points(points) };
    Scan::of(&cloud, SensorModel::PerPoint, mode).expect("a good cloud")
}

/// Measures a surface and prepares the cloud.
pub(crate) fn scan(mesh: &TriangleMesh, spacing: f64, std: f64, seed: u64, mode: Mode) -> Scan {
    prepare(measured(mesh, spacing, std, seed), std, mode)
}

pub(crate) fn mesh(mesh: &TriangleMesh) -> Mesh {
    Mesh::prepare(mesh).expect("a good mesh")
}

/// A query with the default settings of a mode.
pub(crate) fn query(mode: Mode) -> AnyQuery {
    AnyQuery::with(mode, |_| {}, |_| {})
}

/// Runs a default query and checks the report.
pub(crate) fn ask<'a>(
    mode: Mode,
    a: impl Into<Asked<'a>>,
    b: impl Into<Asked<'a>>,
    a_from_b: &Pose,
) -> Report {
    let report = query(mode).run(a, b, a_from_b).expect("a finite pose");
    assert_sound(&report);
    report
}

/// What holds of every report: probabilities are ones, nothing is NaN, normals have unit length.
pub(crate) fn assert_sound(report: &Report) {
    let is_probability = |p: f64| (0.0..=1.0).contains(&p);
    let p = report.collision_probability;
    let [lower, upper] = report.bounds;
    assert!(is_probability(p) && is_probability(lower) && is_probability(upper), "{report:?}");
    assert!(lower <= p && p <= upper, "{p} outside [{lower}, {upper}]");
    assert!(is_probability(report.max_probability) && is_probability(report.noisy_or_probability));
    if let Some(clearance) = &report.clearance_m {
        assert!(clearance.mean.is_finite() && clearance.std.is_finite(), "{clearance:?}");
        assert!(clearance.std >= 0.0, "{clearance:?}");
    }
    for contact in &report.contacts {
        assert!(contact.point.iter().all(|v| v.is_finite()), "{contact:?}");
        // Normalising rounds in the last places only.
        assert!((contact.normal_a_to_b.norm() - 1.0).abs() < 1e-9, "{contact:?}");
        assert!(is_probability(contact.probability), "{contact:?}");
        assert!(contact.clearance_m.is_finite(), "{contact:?}");
    }
    let points = &report.point_probabilities;
    assert!(points.a.iter().chain(&points.b).all(|&(_, p)| is_probability(p)));
    assert!(report.stats.max_relative_gap >= 0.0, "{:?}", report.stats);
}

/// The report without what may differ between equal queries: times, and who prepared a leaf.
pub(crate) fn timeless(report: &Report) -> Report {
    let mut told = report.clone();
    (told.stats.prepare_us, told.stats.query_us, told.stats.leaves_prepared) = (0, 0, 0);
    told
}
