//! Sensor models against their closed forms, and what they do with bad points.

use cloudtouch_geom::{Covariance, Matrix3, Point3, PointCloud, Pose, Vector3};
use cloudtouch_noise::{NoiseError, SensorModel};
use proptest::prelude::*;

fn at(sensor: &str, point: Point3) -> Covariance {
    let cloud = PointCloud::from_points(vec![point]);
    sensor.parse::<SensorModel>().expect("a sensor").covariances(&cloud).expect("noise")[0]
}

/// Compares with the expected matrix to 1e-12 of its largest entry.
fn check(sensor: &str, point: [f64; 3], expected: Matrix3) {
    let found = at(sensor, Point3::from(point)).matrix();
    let tolerance = 1e-12 * expected.amax();
    assert!((found - expected).amax() <= tolerance, "{sensor}: {found} against {expected}");
}

fn diagonal(stds: [f64; 3]) -> Matrix3 {
    Matrix3::from_diagonal(&Vector3::from(stds.map(|s| s * s)))
}

#[test]
fn models_match_their_closed_forms_on_the_axis() {
    let ahead = [0.0, 0.0, 2.0];
    check("exact", ahead, Matrix3::zeros());
    check("iso:0.005", ahead, diagonal([0.005; 3]));
    check("axes:0.3,0.2,0.1", ahead, diagonal([0.3, 0.2, 0.1]));
    // z²/(f b) σ = 4/(500 · 0.1) · 0.25 = 0.02; half a pixel is 2/(2 · 500) = 0.002.
    check("stereo:0.1,500,0.25", ahead, diagonal([0.002, 0.002, 0.02]));
    // 0.0012 + 0.0019 · 1.6² = 0.006064; 0.0014 · 2 = 0.0028.
    check("kinect", ahead, diagonal([0.0028, 0.0028, 0.006064]));
    // 0.001 + 0.002 · 2 along the ray, 0.001 · 2 across it.
    check("tof:0.001,0.002", ahead, diagonal([0.002, 0.002, 0.005]));
    check("tof:0.001,0.002", [0.0, -2.0, 0.0], diagonal([0.002, 0.005, 0.002]));
    // A footprint of 2 · 0.004 = 8 mm has a standard deviation of 2 mm.
    check("lidar:0.02,0.004", [0.0, -2.0, 0.0], diagonal([0.002, 0.02, 0.002]));
    check("grid:0.01", ahead, diagonal([0.01 / 12.0_f64.sqrt(); 3]));
}

#[test]
fn the_depth_component_off_axis_is_the_stated_one() {
    for point in [Point3::new(1.0, 0.0, 2.0), Point3::new(-0.7, 1.1, 2.0)] {
        let ray = point.coords.normalize();
        for (sensor, depth_std) in [("kinect", 0.006064), ("stereo:0.1,500,0.25", 0.02)] {
            // The error along the ray, seen along z alone.
            let along = at(sensor, point).std_along(&ray) * ray.z;
            assert!((along - depth_std).abs() < 1e-12, "{sensor}: {along}");
        }
    }
}

#[test]
fn points_behind_and_beside_a_camera_are_as_noisy_as_ones_it_could_see() {
    for sensor in ["kinect", "stereo:0.1,500,0.25"] {
        let ahead = at(sensor, Point3::new(0.2, 0.1, 2.0));
        let behind = at(sensor, Point3::new(0.2, 0.1, -2.0));
        assert!((ahead.max_std() - behind.max_std()).abs() < 1e-15, "{sensor}");
        // At 90° it counts as half its range deep: the noise at 60°, turned.
        let at_60 = Point3::new(3.0_f64.sqrt(), 0.0, 1.0);
        let beside = at(sensor, Point3::new(0.0, 2.0, 0.0));
        assert!((at(sensor, at_60).max_std() - beside.max_std()).abs() < 1e-12, "{sensor}");
        assert!(beside.max_std() > 1e-3, "{sensor}");
    }
}

#[test]
fn a_point_at_the_sensor_has_finite_noise() {
    for sensor in ["kinect", "stereo:0.1,500,0.25", "tof:0.001,0.002", "lidar:0.02,0.004"] {
        assert!(at(sensor, Point3::origin()).is_finite(), "{sensor}");
    }
    // So near that the square of the range is 0 it had no noise.
    let near = at("kinect", Point3::new(0.0, 0.0, 1e-170));
    assert!((near.max_std() - at("kinect", Point3::origin()).max_std()).abs() < 1e-15);
    let lidar = at("lidar:0.02,0.004", Point3::origin());
    assert!((lidar.matrix() - diagonal([0.02; 3])).amax() < 1e-15);
}

#[test]
fn rays_start_at_the_sensor_origin() {
    let cloud = PointCloud {
        sensor_pose: Some(Pose::from_translation(Vector3::new(5.0, 0.0, 0.0))),
        ..PointCloud::from_points(vec![Point3::new(5.0, 3.0, 0.0)])
    };
    let sensor = SensorModel::Lidar { range_std: 0.02, beam_rad: 0.0 };
    let found = sensor.covariances(&cloud).unwrap()[0].matrix();
    assert!((found - diagonal([0.0, 0.02, 0.0])).amax() < 1e-15);
}

/// The depth was measured along z of the file: a camera that looks along x saw everything beside it.
#[test]
fn a_camera_looks_where_its_pose_says() {
    let ahead = [Point3::new(0.2, -0.1, 1.5), Point3::new(-0.4, 0.3, 2.0)];
    let pose = Pose::from_translation_rpy(Vector3::new(3.0, 2.0, 1.0), [-1.5, 0.1, -1.6]);
    for sensor in ["kinect", "stereo:0.1,500,0.25"] {
        let sensor: SensorModel = sensor.parse().unwrap();
        let optical = sensor.covariances(&PointCloud::from_points(ahead.to_vec())).unwrap();
        let moved = PointCloud {
            sensor_pose: Some(pose),
            ..PointCloud::from_points(ahead.map(|p| pose.transform_point(&p)).to_vec())
        };
        let found = sensor.covariances(&moved).unwrap();
        for (found, optical) in found.iter().zip(optical.iter()) {
            let expected = optical.rotated(pose.rotation()).matrix();
            assert!((found.matrix() - expected).amax() < 1e-12 * expected.amax());
        }
    }
}

/// A file of the Point Cloud Library states half a turn that its points are not in: all of them would
/// lie behind the camera.
#[test]
fn a_turn_that_puts_the_points_behind_the_camera_is_not_believed() {
    let points = vec![Point3::new(0.5, 0.1, 1.0), Point3::new(-0.3, 0.2, 1.4)];
    let turned = PointCloud {
        sensor_pose: Some(Pose::from_translation_rpy(Vector3::zeros(), [0.1 - 3.1, 0.4, 0.0])),
        ..PointCloud::from_points(points.clone())
    };
    let optical = SensorModel::Kinect.covariances(&PointCloud::from_points(points)).unwrap();
    assert_eq!(SensorModel::Kinect.covariances(&turned), Ok(optical));
}

#[test]
fn noise_that_is_the_same_everywhere_is_stored_once() {
    let cloud = PointCloud::from_points(vec![Point3::origin(); 1000]);
    for spec in ["exact", "iso:0.01", "axes:1,2,3", "grid:0.05"] {
        let sensor: SensorModel = spec.parse().unwrap();
        assert!(sensor.covariances(&cloud).unwrap().as_uniform().is_some(), "{spec}");
    }
}

#[test]
fn missing_returns_keep_their_rows() {
    let missing = Point3::new(f64::NAN, 0.0, 0.0);
    let cloud = PointCloud::from_points(vec![missing, Point3::new(0.0, 0.0, 1.0)]);
    let found = SensorModel::Kinect.covariances(&cloud).unwrap();
    assert!(found[0].is_zero() && !found[1].is_zero());
    assert_eq!(SensorModel::Isotropic { std: 0.1 }.covariances(&cloud).unwrap().len(), 2);
    assert!(SensorModel::Kinect.covariances(&PointCloud::default()).unwrap().is_empty());
}

#[test]
fn per_point_noise_is_the_clouds_own() {
    let mut cloud = PointCloud::from_points(vec![Point3::origin(); 2]);
    let sensor = SensorModel::PerPoint;
    assert_eq!(sensor.covariances(&cloud), Err(NoiseError::NoCovariances));
    let own = vec![Covariance::isotropic(1.0), Covariance::diagonal([1.0, 2.0, 0.0])];
    cloud.covariances = Some(own.clone());
    assert_eq!(sensor.covariances(&cloud), Ok(own.into()));
    cloud.covariances = Some(vec![Covariance::zero()]);
    assert_eq!(
        sensor.covariances(&cloud),
        Err(NoiseError::CovarianceCount { points: 2, covariances: 1 })
    );
    cloud.covariances = Some(vec![Covariance::zero(), Covariance::isotropic(f64::INFINITY)]);
    assert!(matches!(
        sensor.covariances(&cloud),
        Err(NoiseError::CovarianceNotFinite { index: 1, .. })
    ));
}

#[test]
fn what_cannot_be_represented_is_refused() {
    let mut cloud = PointCloud::from_points(vec![Point3::new(0.0, 0.0, 1e200)]);
    assert!(matches!(
        SensorModel::Kinect.covariances(&cloud),
        Err(NoiseError::CovarianceNotFinite { index: 0, .. })
    ));
    cloud.sensor_pose = Some(Pose::from_translation(Vector3::new(0.0, f64::NAN, 0.0)));
    assert!(matches!(SensorModel::Exact.covariances(&cloud), Err(NoiseError::SensorPose { .. })));
    assert!(matches!(
        SensorModel::Isotropic { std: -1.0 }.covariances(&cloud),
        Err(NoiseError::SensorValue { value: -1.0, .. })
    ));
}

/// Where its disparity is three standard deviations.
#[test]
fn the_depth_of_a_stereo_camera_is_told_as_far_as_it_errs_by_a_third() {
    let sensor: SensorModel = "stereo:0.1,300,0.08".parse().unwrap();
    let depth = sensor.farthest();
    assert!((depth - 125.0).abs() < 1e-9);
    let std = at("stereo:0.1,300,0.08", Point3::new(0.0, 0.0, depth)).matrix()[(2, 2)].sqrt();
    assert!((std - depth / 3.0).abs() < 1e-9);
    for all_of_it in ["stereo:0.1,300,0", "kinect", "tof:0.01,0.1", "iso:5", "lidar:0.02,0.003"] {
        let sensor: SensorModel = all_of_it.parse().unwrap();
        assert_eq!(sensor.farthest(), f64::INFINITY, "{all_of_it}");
    }
}

proptest! {
    #[test]
    fn lidar_noise_turns_with_the_scene(
        point in prop::array::uniform3(-20.0..20.0_f64),
        turn in prop::array::uniform3(-3.0..3.0_f64),
    ) {
        let pose = Pose::from_translation_rpy(Vector3::zeros(), turn);
        let point = Point3::from(point);
        let turned = at("lidar:0.02,0.003", pose.transform_point(&point));
        let expected = at("lidar:0.02,0.003", point).rotated(pose.rotation());
        prop_assert!((turned.matrix() - expected.matrix()).amax() < 1e-12);
    }

    #[test]
    fn every_covariance_is_one(
        point in prop::array::uniform3(-1e3..1e3_f64),
        sensor in prop::sample::select(vec![
            "exact", "iso:0.01", "axes:1,0,2", "stereo:0.07,400,0", "stereo:0.07,400,3", "kinect",
            "lidar:0,0.1", "lidar:0.1,0", "grid:0.05",
        ]),
    ) {
        let found = at(sensor, Point3::from(point));
        prop_assert!(Covariance::try_from_matrix(&found.matrix()).is_ok());
    }
}
