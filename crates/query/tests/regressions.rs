//! Four slips of an earlier implementation of the paper, each by what a user would have seen.

use crate::common;
use crate::common::{MODES, ask, at, measured, mesh, prepare_each, query};
use cloudtouch::geom::{
    Covariance, Matrix3, Point3, PointCloud, Pose, PoseError, UnitVector3, Vector3,
};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, Mode, PaperCloud, PaperCloudSettings, PaperNoise, PrepareError,
    QueryError, Verdict,
};
use cloudtouch_testkit::scene;
use nalgebra::{Isometry3, Matrix4, Translation3, UnitQuaternion};

/// The upper half of a sphere about the origin, `count` points spread evenly (a Fibonacci lattice):
/// two of them, nested, are apart and no plane separates them.
fn dome(radius: f64, count: usize) -> Vec<Point3> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..count)
        .map(|i| {
            let z = (i as f64 + 0.5) / count as f64;
            let (sin, cos) = (golden * i as f64).sin_cos();
            let across = (1.0 - z * z).sqrt();
            Point3::new(radius * across * cos, radius * across * sin, radius * z)
        })
        .collect()
}

/// Nested domes 10 and 12 cm in radius, small enough to be one leaf each.
fn nested(covariance: impl Fn(&Point3) -> Covariance) -> (PaperCloud, PaperCloud) {
    let cloud = |points: Vec<Point3>| {
        let covariances = points.iter().map(&covariance).collect();
        let mut settings = PaperCloudSettings::amended(SensorModel::PerPoint);
        settings.model.tree.max_leaf_points = 150;
        settings.model.tree.min_leaf_points = 150;
        // Noise and sampling added: the paper's own combination would hide noise that is larger
        // than the sampling.
        settings.model.noise = PaperNoise::Convolution;
        let cloud =
            PointCloud { covariances: Some(covariances), ..PointCloud::from_points(points) };
        PaperCloud::prepare(&cloud, &settings).expect("a good cloud")
    };
    (cloud(dome(0.10, 120)), cloud(dome(0.12, 150)))
}

fn kernel_probability(covariance: impl Fn(&Point3) -> Covariance) -> f64 {
    let (a, b) = nested(covariance);
    let report = ask(Mode::Paper, &a, &b, &Pose::identity());
    assert!(report.stats.kernel_solves > 0, "a plane separates them: {:?}", report.stats);
    report.collision_probability
}

/// A plain classifier per leaf pair knows positions only: the same positions gave the same answer
/// however noisy they were.
#[test]
fn plain_classifier_ignored_the_noise() {
    let with_std = |std: f64| kernel_probability(|_| Covariance::isotropic(std * std));
    let probabilities = [0.0005, 0.003, 0.006].map(with_std);
    // A gap of 2 cm is forty, seven and three deviations wide; each side has half of it.
    let [small, middle, large] = probabilities;
    assert!(middle > small + 0.005 && large > middle + 0.005, "{probabilities:?}");
}

/// Coordinates were scaled to the unit box and covariances were not: a scene in millimetres gave
/// another answer than the same scene in metres.
#[test]
fn covariances_were_left_unscaled() {
    let std = 0.003;
    let floor = measured(&scene::plane_patch(0.3), 0.02, std, 1);
    let ball = measured(&scene::sphere(0.08, 3), 0.016, std, 2);
    for mode in MODES {
        let at_scale = |factor: f64| {
            let cloud = |points: &[Point3]| {
                let covariance = Covariance::isotropic(std * std).scaled(factor);
                let scaled = points.iter().map(|p| p * factor).collect();
                prepare_each(scaled, vec![covariance; points.len()], mode)
            };
            let pose = at(0.0, 0.0, 0.088 * factor);
            ask(mode, &cloud(&floor), &cloud(&ball), &pose).collision_probability
        };
        let (metres, millimetres) = (at_scale(1.0), at_scale(1000.0));
        // A probability that could have gone either way, or the test would prove nothing.
        assert!((0.001..0.999).contains(&metres), "{mode:?}: {metres}");
        // The solver's tolerance.
        assert!((metres - millimetres).abs() < 1e-3, "{mode:?}: {metres} and {millimetres}");
    }
}

/// The gradient was taken as the longest partial sum of its terms. Terms along the surface cancel
/// in the whole sum and not in a part of it, so noise along the surface pushed P towards one half.
#[test]
fn partial_gradient_sums_made_noise_along_the_surface_count() {
    let std = 0.006;
    // A disc in the tangent plane of the dome: no noise toward the other dome.
    let tangential =
        |p: &Point3| Covariance::from_axis(&UnitVector3::new_normalize(p.coords), 0.0, std);
    let radial =
        |p: &Point3| Covariance::from_axis(&UnitVector3::new_normalize(p.coords), std, 0.0);
    let none = kernel_probability(|_| Covariance::zero());
    let (along, toward) = (kernel_probability(tangential), kernel_probability(radial));
    // The gap of 2 cm is 1.7 deviations of radial noise for each side: Φ(−1.7) = 0.05 at best.
    assert!(toward > 0.03, "noise toward the other surface: {toward}");
    // Without noise of its own the sampling is what is left; noise along the surface adds to it,
    // but less than half of what noise toward the other surface makes.
    assert!(along < 0.5 * toward, "along {along}, toward {toward}, none {none}");
}

/// Eq. 16 in full where it is known in closed form: the signed distance to a mesh has a gradient of
/// length one, so P = Φ(−d/σ) with σ the noise toward the mesh.
#[test]
fn probabilities_of_points_are_those_of_equation_16() {
    let stds = [0.03, 0.002, 0.01];
    let points: Vec<Point3> =
        (1..11).map(|i| Point3::new(0.02 * f64::from(i), 0.0, -0.005 * f64::from(i))).collect();
    let covariance = Covariance::diagonal(stds.map(|s| s * s));
    // About where they were measured: exact up to rounding. The deepest is certain to be inside, so
    // that no leaf pair is asked as well.
    let mut settings = PaperCloudSettings::amended(SensorModel::PerPoint);
    settings.model.noise = PaperNoise::Convolution;
    let cloud = PointCloud {
        covariances: Some(vec![covariance; 10]),
        ..PointCloud::from_points(points.clone())
    };
    let convolution = PaperCloud::prepare(&cloud, &settings).unwrap();
    // A box whose top is the plane z = 0, far wider than the cloud.
    let block = mesh(&scene::cuboid([2.0, 2.0, 1.0]));
    let report = ask(Mode::Paper, &convolution, &block, &at(0.0, 0.0, -0.5));
    for &(index, probability) in &report.point_probabilities.a {
        // Discretization adds variance, so at least Σ alone; a line of points in x and z has none
        // along y, and its own slope 1/4 bounds what is added along z by 1/16 of that along x.
        let height = points[index].z;
        let ceiling = cloudtouch::geom::normal::upper_tail(height / stds[2]);
        let spread = 0.25 * 0.2;
        let floor = cloudtouch::geom::normal::upper_tail(height / stds[2].hypot(spread));
        assert!(probability >= floor - 1e-12, "{index}: {probability} < {floor}");
        assert!(probability <= ceiling + 1e-12, "{index}: {probability} > {ceiling}");
    }
    assert_eq!(report.point_probabilities.a.len(), 10, "{:?}", report.point_probabilities);
}

/// NaN compared false with every threshold and ended as probability 0, which read as free.
#[test]
fn nan_ended_as_probability_zero() {
    let nan = f64::NAN;
    // In a covariance: an error when it is made, so that no cloud can hold it.
    assert!(Covariance::try_from_matrix(&Matrix3::repeat(nan)).is_err());
    // In one that was not checked: an error when the cloud is prepared.
    let points = measured(&scene::plane_patch(0.2), 0.02, 0.001, 1);
    let mut covariances = vec![Covariance::isotropic(1e-6); points.len()];
    covariances[5] = Covariance::from_symmetric(&Matrix3::from_element(nan));
    let cloud =
        PointCloud { covariances: Some(covariances), ..PointCloud::from_points(points.clone()) };
    let settings = CloudSettings::new(SensorModel::PerPoint);
    let error = Cloud::prepare(&cloud, &settings).unwrap_err();
    assert!(matches!(error, PrepareError::Noise(_)), "{error}");
    // In the noise of a sensor: an error.
    let settings = CloudSettings::new(SensorModel::Isotropic { std: nan });
    assert!(Cloud::prepare(&PointCloud::from_points(points.clone()), &settings).is_err());
    // In a point: dropped, and counted.
    let mut holed = points.clone();
    holed[3].z = nan;
    let good = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    let prepared = Cloud::prepare(&PointCloud::from_points(holed), &good).unwrap();
    assert_eq!(prepared.filter_stages()[0].removed, 1);
    // In the sensor's place: an error where the place matters.
    let lost = PointCloud {
        sensor_pose: Some(Pose::from_translation(Vector3::new(0.0, nan, 0.0))),
        ..PointCloud::from_points(points)
    };
    let kinect = CloudSettings::new(SensorModel::Kinect);
    assert!(Cloud::prepare(&lost, &kinect).is_err());
}

/// ... and in a pose.
#[test]
fn nan_in_a_pose_is_an_error() {
    for value in [f64::NAN, f64::INFINITY] {
        let mut matrix = Matrix4::identity();
        matrix[(1, 3)] = value;
        let error = Pose::try_from_matrix(&matrix).unwrap_err();
        assert!(matches!(error, PoseError::NotFinite { row: 1, column: 3, .. }), "{error}");
        // Past the check of the matrix, the query looks itself.
        let isometry =
            Isometry3::from_parts(Translation3::new(0.0, value, 0.0), UnitQuaternion::identity());
        let pose = Pose::from_isometry(isometry);
        let ball = mesh(&scene::sphere(0.1, 2));
        let cloud = common::scan(&scene::plane_patch(0.2), 0.02, 0.001, 1, Mode::Calibrated);
        let query = query(Mode::Calibrated);
        let cloud_and_mesh = query.run(&cloud, &ball, &pose);
        assert!(matches!(cloud_and_mesh, Err(QueryError::Pose { .. })), "{cloud_and_mesh:?}");
        let meshes = query.run(&ball, &ball, &pose);
        assert!(matches!(meshes, Err(QueryError::Pose { .. })), "{meshes:?}");
        let batch = query.run_batch(&cloud, &ball, &[pose, Pose::identity()]);
        assert!(batch[0].is_err(), "a bad pose of a batch is its own error");
        assert_ne!(batch[1].as_ref().unwrap().verdict, Verdict::Free, "the rest goes on");
    }
}

/// A gripper that points down was turned about y by half a turn; the matrix of that was taken for none at all,
/// and a box deep in a ball was free.
#[test]
fn a_half_turn_is_not_taken_for_none() {
    let at = |x| Pose::from_translation(Vector3::new(x, 0.0, 0.0));
    let ball = scene::moved(&scene::sphere(0.1, 3), &at(0.3));
    let cloud = common::scan(&ball, 0.005, 0.001, 1, Mode::Calibrated);
    // Beside the origin of its frame, so that it is the turn that brings it to the ball.
    let held = mesh(&scene::moved(&scene::cuboid([0.06; 3]), &at(-0.23)));
    let half_turn = Matrix4::from_diagonal(&nalgebra::Vector4::new(-1.0, 1.0, -1.0, 1.0));
    let pose = Pose::try_from_matrix(&half_turn).unwrap();
    let query = query(Mode::Calibrated);
    assert_eq!(query.run(&cloud, &held, &pose).unwrap().verdict, Verdict::InCollision);
    let as_if_none = query.run(&cloud, &held, &Pose::identity()).unwrap();
    assert_eq!(as_if_none.verdict, Verdict::Free, "{as_if_none:?}");
}

/// A scene placed so far away that differences overflow is not free either.
#[test]
fn overflow_is_not_free() {
    let ball = mesh(&scene::sphere(0.1, 2));
    let cloud = common::scan(&scene::plane_patch(0.2), 0.02, 0.001, 1, Mode::Calibrated);
    let pose = Pose::from_translation(Vector3::repeat(1e300));
    match query(Mode::Calibrated).run(&cloud, &ball, &pose) {
        // Truly far away: free is right, as long as every number is one.
        Ok(report) => common::assert_sound(&report),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
