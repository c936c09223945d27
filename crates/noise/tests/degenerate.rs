//! Clouds without a surface to fit: refinement stays finite and says what it knows.

use crate::common;
use cloudtouch_geom::{Covariance, Matrix3, Point3, Vector3};
use cloudtouch_noise::{
    Combination, Discretization, Neighborhoods, NoiseError, NoiseModel, NoiseSettings,
    PosteriorSettings, Scratch, SensorNoise,
};

use crate::common::{isotropic, model, plane, refine_all};

const NOISE: f64 = 0.01;

/// The posterior of every point, and that each is finite and where it was measured.
fn stays_put(points: &[Point3], noise: f64) -> Vec<Covariance> {
    let sensor = isotropic(noise, points);
    refine_all(&model(Combination::SurfacePosterior), points, &sensor)
        .into_iter()
        .zip(points)
        .map(|(refined, point)| {
            assert_eq!(refined.point.mean, *point);
            assert_eq!(refined.normal, None);
            assert!(refined.point.covariance.is_finite());
            refined.point.covariance
        })
        .collect()
}

#[test]
fn a_point_alone_keeps_its_sensor_noise() {
    for points in [vec![Point3::new(1.0, 2.0, 3.0)], vec![Point3::new(1.0, 2.0, 3.0); 50]] {
        for covariance in stays_put(&points, NOISE) {
            assert_eq!(covariance, Covariance::isotropic(NOISE * NOISE));
        }
        assert!(stays_put(&points, 0.0).iter().all(Covariance::is_zero));
    }
}

#[test]
fn a_point_alone_is_uncertain_by_the_cap_under_convolution() {
    let index = Neighborhoods::new(vec![Point3::origin()]).unwrap();
    let sensor = SensorNoise::from(vec![Covariance::isotropic(NOISE * NOISE)]);
    let refine = |combination, cap| {
        let mut scratch = Scratch::default();
        model(combination).refine(0, &index, &sensor, cap, &mut scratch).point.covariance
    };
    let wide = refine(Combination::Convolution, 0.3).max_std();
    assert!((wide - 0.3_f64.hypot(NOISE)).abs() < 1e-12);
    assert_eq!(refine(Combination::Convolution, f64::INFINITY), sensor[0]);
    assert_eq!(refine(Combination::Precision, 0.3), sensor[0]);
}

#[test]
fn points_on_a_line_are_uncertain_by_their_spacing_in_every_direction() {
    let direction = Vector3::new(1.0, 2.0, 3.0).normalize();
    for count in [2, 3, 5, 100] {
        let points: Vec<_> =
            (0..count).map(|i| Point3::from(direction * (0.1 * f64::from(i)))).collect();
        for covariance in stays_put(&points, NOISE) {
            let isotropic = Matrix3::identity() * covariance.upper_triangle()[0];
            assert!((covariance.matrix() - isotropic).amax() < 1e-15);
            assert!(covariance.max_std() > NOISE.hypot(0.03), "{}", covariance.max_std());
        }
    }
}

#[test]
fn three_points_fit_any_plane_and_none_is_fitted() {
    let points = [Point3::origin(), Point3::new(0.1, 0.0, 0.0), Point3::new(0.0, 0.1, 0.0)];
    stays_put(&points, NOISE);
}

#[test]
fn an_exact_coplanar_cloud_has_exact_normals_and_does_not_move() {
    let surface = plane(0.4, 0.02, 3);
    let sensor = isotropic(0.0, &surface.points);
    for (refined, point) in
        refine_all(&model(Combination::SurfacePosterior), &surface.points, &sensor)
            .iter()
            .zip(&surface.points)
    {
        assert_eq!(refined.point.mean, *point);
        assert!(refined.normal.unwrap().z.abs() > 1.0 - 1e-12);
        // What bends between samples is all that is left along the normal; at an end these are farther apart
        // than as many all around would be, as half of the disc that tells is empty.
        let sampling = PosteriorSettings::default().sampling_std;
        let along = refined.point.covariance.std_along(&refined.normal.unwrap());
        let told = sampling * refined.spacing;
        assert!((told - 1e-12..std::f64::consts::SQRT_2 * told + 1e-12).contains(&along));
    }
}

#[test]
fn missing_returns_change_nothing_for_the_others() {
    let surface = plane(0.2, 0.02, 3);
    let model = model(Combination::SurfacePosterior);
    let mut points = surface.points.clone();
    points.push(Point3::new(f64::NAN, 0.0, 0.0));
    let with = refine_all(&model, &points, &isotropic(1e-3, &points));
    let without = refine_all(&model, &surface.points, &isotropic(1e-3, &surface.points));
    assert_eq!(with[..without.len()], without[..]);
    assert_eq!(with[without.len()].normal, None);
}

#[test]
fn a_cloud_stored_twice_is_the_cloud() {
    let surface = plane(0.2, 0.02, 3);
    let sensor = vec![Covariance::isotropic(1e-6); surface.points.len()];
    let model = model(Combination::SurfacePosterior);
    let once = refine_all(&model, &surface.points, &sensor.clone().into());
    let twice = refine_all(&model, &surface.points.repeat(2), &sensor.repeat(2).into());
    assert_eq!(twice[..once.len()], once[..]);
    assert_eq!(twice[once.len()..], once[..]);
}

#[test]
fn scenes_of_any_size_are_refined_alike() {
    let surface = plane(0.3, 0.02, 3);
    let points = common::noisy(&surface.points, 0.002, 4);
    let model = model(Combination::SurfacePosterior);
    let refine = |scale: f64| {
        let scaled: Vec<_> = points.iter().map(|p| Point3::from(p.coords * scale)).collect();
        refine_all(&model, &scaled, &isotropic(0.002 * scale, &scaled))
    };
    let unit = refine(1.0);
    for scale in [1e-6, 1e6] {
        for (a, b) in refine(scale).iter().zip(&unit) {
            assert!((a.point.mean.coords / scale - b.point.mean.coords).amax() < 1e-9);
            assert!((a.spacing / scale - b.spacing).abs() < 1e-9);
        }
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let fine = NoiseSettings::default();
    let discretization = Discretization { neighbors: 0, ..fine.discretization };
    let disc = |disc_std| NoiseSettings {
        posterior: PosteriorSettings { disc_std, ..fine.posterior },
        ..fine
    };
    for (settings, name) in [
        (disc(-0.1), "posterior.disc_std"),
        (disc(f64::NAN), "posterior.disc_std"),
        (NoiseSettings { discretization, ..fine }, "discretization.neighbors"),
    ] {
        let error = NoiseModel::new(settings).unwrap_err();
        assert!(matches!(error, NoiseError::Setting(found) if found.name == name), "{error}");
    }
}
