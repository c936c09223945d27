//! A pose that is known only so well.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use std::io::Write as _;

use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3, normal, seed};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Body, Cloud, CloudSettings, Mesh, PoseDistribution, Query, QueryError, QuerySettings, Report,
};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::{scene, surface};

fn cloud(mesh: &TriangleMesh, std: f64, seed: u64) -> Body {
    let samples = surface::positions(&surface::sample_surface(mesh, 1200, seed));
    let points: Vec<Point3> = add_noise(&samples, NoiseKind::Gaussian, std, seed);
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    Body::Cloud(
        Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap().refined().unwrap(),
    )
}

fn bodies(is_mesh: bool, seed: u64) -> (Body, Body) {
    let shape = scene::cuboid([0.2; 3]);
    let b = if is_mesh {
        Body::from(Mesh::prepare(&shape).unwrap())
    } else {
        cloud(&shape, 0.002, !seed)
    };
    (cloud(&shape, 0.002, seed), b)
}

fn query() -> Query {
    Query::new(QuerySettings::default()).unwrap()
}

/// How far the answer is from the mean over so many poses drawn at random, and how many poses it took.
fn error_of_case(case: u64, draws: u64) -> (f64, usize) {
    let draw = |k: u64| seed::unit(seed::derive(case, k, 1));
    let (a, b) = bodies(case.is_multiple_of(2), case);
    // Around contact of the boxes' faces, aslant.
    let offset = Vector3::new(0.1 * draw(0) - 0.05, 0.1 * draw(1) - 0.05, 0.17 + 0.1 * draw(2));
    let mean = Pose::from_translation_rpy(offset, [0.6 * draw(3), 0.6 * draw(4), 3.0 * draw(5)]);
    let stds: [f64; 6] = std::array::from_fn(|k| {
        let largest = if k < 3 { 0.02 } else { 0.1 };
        largest * draw(6 + k as u64) * f64::from(u8::from(draw(12 + k as u64) > 0.3))
    });
    let (_, under) =
        query().run_uncertain(&a, &b, &PoseDistribution::from_std(mean, stds)).unwrap();
    let [low, high] = under.bounds;
    assert!(low <= under.probability && under.probability <= high, "{under:?}");
    let gauss =
        |i, k| normal::quantile(seed::unit(seed::derive(!case, i, k)).clamp(1e-9, 1.0 - 1e-9));
    let pose = |i: u64| {
        let motion: [f64; 6] = std::array::from_fn(|k| stds[k] * gauss(i, k as u64));
        let turn = nalgebra::UnitQuaternion::from_scaled_axis(Vector3::new(
            motion[3], motion[4], motion[5],
        ));
        let shift = Vector3::new(motion[0], motion[1], motion[2]);
        mean.after(&Pose::from_translation_rotation(shift, turn))
    };
    let poses: Vec<Pose> = (0..draws).map(pose).collect();
    let all = query().run_batch(&a, &b, &poses);
    let sum: f64 = all.into_iter().map(|answer| answer.unwrap().collision_probability).sum();
    ((under.probability - sum / draws as f64).abs(), under.poses)
}

#[test]
fn an_uncertain_pose_is_the_mean_over_what_it_may_be() {
    let errors: Vec<f64> = (0..6).map(|case| error_of_case(case, 400).0).collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    assert!(mean < 0.02 && errors.iter().all(|error| *error < 0.08), "{errors:?}");
}

/// Run it for the figures:
/// `cargo test --release -p cloudtouch --test suite uncertain_pose:: -- --ignored --nocapture`.
#[test]
#[ignore = "minutes"]
fn two_hundred_cases_against_a_thousand_poses_each() {
    let (errors, poses): (Vec<f64>, Vec<usize>) =
        (0..200).map(|case| error_of_case(case, 1000)).unzip();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let queries = poses.iter().sum::<usize>() as f64 / poses.len() as f64;
    let worst = errors.iter().copied().fold(0.0, f64::max);
    writeln!(std::io::stderr(), "mean {mean:.4}, worst {worst:.4}, {queries:.1} poses").unwrap();
    assert!(mean < 0.02 && worst < 0.08);
}

#[test]
fn a_pose_that_is_known_is_the_plain_answer_to_the_bit() {
    let (a, b) = bodies(true, 3);
    let mean = Pose::from_translation(Vector3::new(0.01, 0.0, 0.2));
    let plain = query().run(&a, &b, &mean).unwrap();
    let known = PoseDistribution::from_std(mean, [0.0; 6]);
    let (report, under) = query().run_uncertain(&a, &b, &known).unwrap();
    assert_eq!(under.probability.to_bits(), plain.collision_probability.to_bits());
    assert_eq!((under.bounds, under.poses), (report.bounds, 1));
}

#[test]
fn the_report_is_that_of_the_most_probable_pose_to_the_bit() {
    for (is_mesh, z) in [(true, 0.19), (true, 0.21), (false, 0.19), (false, 0.21), (false, 0.3)] {
        let (a, b) = bodies(is_mesh, 3);
        let mean = Pose::from_translation_rpy(Vector3::new(0.01, 0.0, z), [0.1, 0.0, 0.3]);
        let plain = query().run(&a, &b, &mean).unwrap();
        let known_roughly = PoseDistribution::from_std(mean, [0.005; 6]);
        let (report, _) = query().run_uncertain(&a, &b, &known_roughly).unwrap();
        let of = |report: &Report| {
            let Report { collision_probability, bounds, contacts, clearance_m, verdict, .. } =
                report;
            format!("{collision_probability:e} {bounds:?} {contacts:?} {clearance_m:?} {verdict:?}")
        };
        assert_eq!(of(&report), of(&plain));
    }
}

#[test]
fn where_no_pose_comes_near_none_is_asked_about() {
    let (a, b) = bodies(false, 3);
    let far =
        PoseDistribution::from_std(Pose::from_translation(Vector3::new(0.0, 0.0, 1.0)), [0.005; 6]);
    let (_, under) = query().run_uncertain(&a, &b, &far).unwrap();
    assert!(under.poses == 1 && under.bounds[1] < 0.01, "{under:?}");
}

/// A box two deviations above a plate: seven poses all said free, and so did the answer, beyond doubt.
#[test]
fn what_only_the_farthest_poses_do_was_never() {
    let plate = cloud(&scene::plane_patch(1.0), 0.002, 5);
    let block = Body::from(Mesh::prepare(&scene::cuboid([0.2; 3])).unwrap());
    let mean = Pose::from_translation(Vector3::new(0.0, 0.0, 0.2));
    let below = |deviations: f64| normal::cdf(-deviations);
    for (std, most_off) in [(0.05, 0.012), (0.04, 0.005), (0.1, 0.03), (0.03, 0.003)] {
        let known = PoseDistribution::from_std(mean, [0.0, 0.0, std, 0.0, 0.0, 0.0]);
        let (_, under) = query().run_uncertain(&plate, &block, &known).unwrap();
        // From where the lower face is at the plate to where the upper one is.
        let truth = below(0.1 / std) - below(0.3 / std);
        assert!((under.probability - truth).abs() < most_off, "{std}: {truth} but {under:?}");
        assert!((under.probability - truth).abs() < 2.0 * under.std_error, "{truth}: {under:?}");
    }
    // So far about that none of the poses asked about hits it.
    let known = PoseDistribution::from_std(mean, [0.0, 0.0, 5.0, 0.0, 0.0, 0.0]);
    let (_, under) = query().run_uncertain(&plate, &block, &known).unwrap();
    let truth = below(0.1 / 5.0) - below(0.3 / 5.0);
    assert!((under.probability - truth).abs() < 2.0 * under.std_error, "{truth}: {under:?}");
}

#[test]
fn no_pose_has_such_a_covariance() {
    let (a, b) = bodies(true, 3);
    let good = PoseDistribution::from_std(Pose::identity(), [0.01; 6]);
    let mut all = [good; 3];
    all[0].covariance[2][2] = -1e-4;
    all[1].covariance[0][1] = 1e-4;
    all[2].covariance[4][4] = f64::NAN;
    for bad in all {
        let error = query().run_uncertain(&a, &b, &bad).unwrap_err();
        assert!(matches!(error, QueryError::PoseCovariance { .. }), "{error}");
    }
}

/// Its eigenvalues are beyond all numbers: it was dropped, or a margin was blamed that nobody gave.
#[test]
fn a_covariance_as_wide_as_all_numbers_is_refused_by_its_name() {
    let (a, b) = bodies(true, 3);
    let mean = Pose::from_translation(Vector3::new(0.0, 0.0, 1.0));
    let of = |covariance| PoseDistribution { mean, covariance };
    let alone = |std| PoseDistribution::from_std(mean, [std; 6]);
    for bad in [of([[1e308; 6]; 6]), of([[1e300; 6]; 6]), alone(1e154), alone(1e100), alone(1e11)] {
        let error = query().run_uncertain(&a, &b, &bad).unwrap_err();
        assert!(matches!(error, QueryError::PoseCovariance { .. }), "{error}");
    }
    // As far as that a pose is asked about.
    query().run_uncertain(&a, &b, &alone(1e9)).expect("poses of finite coordinates");
}
