//! A cloud that brings its normals is not fitted: they are believed.

use crate::common::{ask, at};
use cloudtouch::geom::{Covariance, Point3, PointCloud, UnitVector3, Vector3};
use cloudtouch::noise::{NoiseError, SensorModel};
use cloudtouch::{Cloud, CloudSettings, FilterError, Mode, PrepareError};

/// A square of 40 cm, a point every 2 cm, with these normals.
fn sheet(normal: UnitVector3) -> PointCloud {
    let place = |i: usize| Point3::new(0.02 * (i % 20) as f64, 0.02 * (i / 20) as f64, 0.0);
    let points: Vec<Point3> = (0..400).map(place).collect();
    PointCloud { normals: Some(vec![normal; points.len()]), ..PointCloud::from_points(points) }
}

fn prepare(cloud: &PointCloud) -> Result<Cloud, PrepareError> {
    let sensor = SensorModel::Isotropic { std: 0.0 };
    Cloud::prepare(cloud, &CloudSettings::new(sensor))
}

/// Discs across their normals: sheets 1 cm apart are far from each other, in deviations, when they
/// lie flat, and reach into each other when every disc is told to stand upright.
#[test]
fn discs_lie_across_the_normals_given() {
    let deviations = |normal| {
        let cloud = prepare(&sheet(normal)).unwrap();
        ask(Mode::Calibrated, &cloud, &cloud, &at(0.0, 0.0, 0.01)).evidence.unwrap().deviations
    };
    let (flat, upright) = (deviations(Vector3::z_axis()), deviations(Vector3::x_axis()));
    // Six is as far as is told.
    assert!(flat == 6.0 && upright < 1.5, "flat {flat}, upright {upright}");
    // The side it points to does not matter.
    assert_eq!(flat, deviations(-Vector3::z_axis()));
}

#[test]
fn normals_that_are_none_are_refused() {
    for bad in [Vector3::zeros(), Vector3::new(f64::NAN, 0.0, 1.0), Vector3::z() * 2.0] {
        let error = prepare(&sheet(UnitVector3::new_unchecked(bad))).unwrap_err();
        assert!(matches!(error, PrepareError::Normal { index: 0, .. }), "{error}");
    }
    let mut short = sheet(Vector3::z_axis());
    short.normals = Some(vec![Vector3::z_axis(); 399]);
    let error = prepare(&short).unwrap_err();
    let wanted = FilterError::Count { what: "normals", count: 399, points: 400 };
    assert_eq!(error, PrepareError::Filter(wanted));
}

/// By their places among the points that were kept: row 7 was called point 5.
#[test]
fn what_is_wrong_with_a_point_is_told_by_its_row() {
    let nowhere = Point3::new(f64::NAN, 0.0, 0.0);
    let mut scan = sheet(Vector3::z_axis());
    (scan.points[2], scan.points[4]) = (nowhere, nowhere);
    let mut bad_normal = scan.clone();
    bad_normal.normals.as_mut().unwrap()[7] = UnitVector3::new_unchecked(Vector3::zeros());
    let error = prepare(&bad_normal).unwrap_err();
    assert!(matches!(error, PrepareError::Normal { index: 7, .. }), "{error}");

    let mut covariances = vec![Covariance::isotropic(1e-6); scan.len()];
    covariances[7] = Covariance::isotropic(f64::NAN);
    scan.covariances = Some(covariances);
    let by = CloudSettings::new(SensorModel::PerPoint);
    let error = Cloud::prepare(&scan, &by).unwrap_err();
    let is_told =
        matches!(error, PrepareError::Noise(NoiseError::CovarianceNotFinite { index: 7, .. }));
    assert!(is_told, "{error}");
    // Of several scans the one is named, by whose own rows it is told.
    scan.normals = None;
    let mut good = scan.clone();
    good.covariances = Some(vec![Covariance::isotropic(1e-6); scan.len()]);
    let error = Cloud::merge(&[(&good, &by), (&scan, &by)]).unwrap_err();
    let told = error.to_string();
    assert!(told.starts_with("scan 2 of 2: ") && told.contains("point 7 "), "{told}");
}
