//! Where a surface ends: what noise took past its end comes back, and spacings are those of its middle.

use cloudtouch_geom::{Covariance, Point3, Pose, Vector3};
use cloudtouch_noise::{Combination, Neighborhoods, Refined, Scratch, SensorNoise};

use crate::common::{isotropic, model, noisy, plane, refine_all, root_mean_square};

/// Half the side of the squares, m.
const HALF: f64 = 0.3;

fn posterior(points: &[Point3], sensor: &SensorNoise) -> Vec<Refined> {
    refine_all(&model(Combination::SurfacePosterior), points, sensor)
}

/// How far a place is past the outline of the square, m; less than nothing within it.
fn past(place: &Point3) -> f64 {
    place.x.abs().max(place.y.abs()) - HALF
}

/// Root mean square of how far places are past the outline, over all that were measured past it, m.
fn overhang(measured: &[Point3], places: impl Iterator<Item = Point3>) -> f64 {
    let beyond = measured.iter().zip(places).filter(|(measured, _)| past(measured) > 0.0);
    root_mean_square(beyond.map(|(_, place)| past(&place).max(0.0)))
}

/// Points past an end were left there, on a surface that went on as far as anybody could tell.
#[test]
fn what_noise_took_past_an_end_comes_back() {
    for (spacing, std, left) in [(0.015, 0.01, 0.8), (0.015, 0.02, 0.6), (0.005, 0.01, 0.6)] {
        let measured = noisy(&plane(2.0 * HALF, spacing, 1).points, std, 7);
        let refined = posterior(&measured, &isotropic(std, &measured));
        let before = overhang(&measured, measured.iter().copied());
        let after = overhang(&measured, refined.iter().map(|r| r.point.mean));
        assert!(after < left * before, "{spacing}, {std}: {after} m of {before} m");
    }
}

/// Amid a surface chance alone makes one side denser, and points stay about where they were measured.
#[test]
fn amid_a_surface_points_stay_where_they_are_along_it() {
    for (spacing, std) in [(0.015, 0.002), (0.015, 0.01), (0.005, 0.01)] {
        let measured = noisy(&plane(2.0 * HALF, spacing, 1).points, std, 7);
        let refined = posterior(&measured, &isotropic(std, &measured));
        let amid = measured.iter().zip(&refined).filter(|(p, _)| past(p) < -0.08);
        let moved = root_mean_square(amid.map(|(p, r)| (r.point.mean - p).xy().norm()));
        assert!(moved < 0.3 * std, "{spacing}, {std}: {moved} m");
    }
}

/// A depth camera blurs along its rays: what has no noise across them is not past the end. What is left is that
/// fitted normals are a little off.
#[test]
fn noise_across_the_surface_alone_takes_nothing_past_its_end() {
    let samples = plane(2.0 * HALF, 0.015, 1).points;
    let moved = |along: f64| {
        let by = Vector3::new(along, along, 1.0);
        let measured: Vec<Point3> = (samples.iter().zip(noisy(&samples, 0.01, 7)))
            .map(|(at, noisy)| at + (noisy - at).component_mul(&by))
            .collect();
        let variances = [1e-4 * along * along, 1e-4 * along * along, 1e-4];
        let sensor = SensorNoise::uniform(Covariance::diagonal(variances), measured.len());
        let refined = posterior(&measured, &sensor);
        let at_end = measured.iter().zip(&refined).filter(|(p, _)| past(p) > -0.015);
        let moved: Vec<f64> = at_end.map(|(p, r)| past(&r.point.mean) - past(p)).collect();
        moved.iter().sum::<f64>() / moved.len() as f64
    };
    let (with, without) = (moved(1.0), moved(0.0));
    assert!(with < -0.002 && without.abs() < 0.0006, "{with}, {without}");
}

/// Samples of the square as even as the pixels of a camera.
fn lattice(spacing: f64) -> Vec<Point3> {
    let steps = (2.0 * HALF / spacing) as i32;
    let at = |step: i32| (f64::from(step) + 0.5) * spacing - HALF;
    (0..steps * steps).map(|i| Point3::new(at(i / steps), at(i % steps), 0.0)).collect()
}

/// How far points near the outline moved outwards, in the mean, in parts of the noise that is stated, without a
/// direction.
fn moved_outwards(measured: &[Point3], std: f64, within: f64) -> f64 {
    let refined = posterior(measured, &isotropic(std, measured));
    let near = measured.iter().zip(&refined).filter(|(p, _)| past(p) > -within);
    let moved: Vec<f64> = near.map(|(p, r)| past(&r.point.mean) - past(p)).collect();
    moved.iter().sum::<f64>() / (moved.len() as f64 * std)
}

/// Edges of what a depth camera sees were drawn in by up to .8 of the deviation, where `iso` was stated for it and all
/// of its noise is along the rays: bodies beside them read as free. Samples so even were not displaced.
#[test]
fn what_is_even_was_not_displaced_whatever_is_stated() {
    let spacing = 0.015;
    for (stated, along) in [(0.33, 0.33), (0.67, 0.33), (1.0, 0.5), (2.0, 0.5), (4.0, 1.0)] {
        let samples = lattice(spacing);
        let measured: Vec<Point3> = (samples.iter().zip(noisy(&samples, along * spacing, 7)))
            .map(|(at, noisy)| Point3::new(at.x, at.y, noisy.z))
            .collect();
        let moved = moved_outwards(&measured, stated * spacing, spacing);
        assert!(moved > -0.11, "{stated} stated, {along} along the rays: {moved}");
    }
}

/// Noise that there is displaces samples of a lattice no less than others.
#[test]
fn what_was_even_before_it_was_displaced_comes_back() {
    let spacing = 0.015;
    for (std, least) in [(0.2, 0.08), (0.33, 0.13), (1.0, 0.4), (2.0, 0.6)] {
        let [even, scattered] =
            [lattice(spacing), plane(2.0 * HALF, spacing, 1).points].map(|samples| {
                moved_outwards(&noisy(&samples, std * spacing, 7), std * spacing, spacing)
            });
        assert!(even < -least && even < 0.85 * scattered, "{std}: {even}, {scattered}");
    }
}

/// Half the disc that a spacing is told from is empty at an end: it was told larger there by 40 %.
#[test]
fn spacings_at_an_end_are_those_of_the_middle() {
    let points = plane(2.0 * HALF, 0.015, 1).points;
    let refined = posterior(&points, &isotropic(0.0, &points));
    let mean = |from: f64, to: f64| {
        let all = points.iter().zip(&refined).filter(|(p, _)| (from..to).contains(&past(p)));
        let (sum, count) = all.fold((0.0, 0.0), |(sum, n), (_, r)| (sum + r.spacing, n + 1.0));
        sum / count
    };
    let (end, middle) = (mean(-0.0075, 0.0), mean(-HALF, -0.08));
    assert!((0.014..0.016).contains(&middle), "{middle}");
    assert!((0.9..1.15).contains(&(end / middle)), "{end} of {middle}");
}

/// The property tests of frames ask this of answers; here of what they rest on.
#[test]
fn what_comes_back_turns_and_moves_with_the_cloud() {
    let measured = noisy(&plane(0.3, 0.015, 1).points, 0.01, 7);
    let pose = Pose::from_translation_rpy(Vector3::new(1.0, -2.0, 0.5), [0.3, 0.8, -0.4]);
    let turned: Vec<Point3> = measured.iter().map(|p| pose.transform_point(p)).collect();
    let model = model(Combination::SurfacePosterior);
    let told = |points: &[Point3], index| {
        let near = Neighborhoods::new(points.to_vec()).unwrap();
        let sensor = isotropic(0.01, points);
        let mut scratch = Scratch::default();
        model.refine(index, &near, &sensor, f64::INFINITY, &mut scratch).point.mean
    };
    for index in (0..measured.len()).step_by(7) {
        let moved = pose.transform_point(&told(&measured, index)) - told(&turned, index);
        assert!(moved.norm() < 1e-9, "{index}: {moved}");
    }
}
