//! Samples closer together than their noise, as a depth camera's are from two metres on.

use cloudtouch_geom::{Point3, PointCloud, UnitVector3, Vector3};
use cloudtouch_noise::{
    Combination, Neighborhoods, Refined, Representatives, Scratch, SensorModel, SensorNoise,
    spacings_at,
};

use crate::common::{gaussian, isotropic, model, noisy, plane, root_mean_square};

/// The points that stand for all where there are some, by index, and what they become.
fn refined(points: &[Point3], sensor: &SensorNoise) -> Vec<(usize, Refined)> {
    let cloud = Neighborhoods::new(points.to_vec()).expect("an index");
    let sample: Vec<usize> = (0..points.len()).step_by(37).collect();
    let spacings = spacings_at(&cloud, sample.iter().copied());
    let chosen = Representatives::choose(&cloud, sensor, (&sample, &spacings)).expect("an index");
    let chosen = chosen.expect("samples denser than their noise");
    let model = model(Combination::SurfacePosterior);
    let mut scratch = Scratch::default();
    let refine = |index| {
        let cap = f64::INFINITY;
        model.refine_representative(index, &cloud, &chosen, sensor, cap, &mut scratch)
    };
    let indices = chosen.indices().iter().map(|&index| index as usize);
    indices.clone().zip(indices.map(refine)).collect()
}

/// What noise takes off a surface is among few others, so that its neighbours seemed to be farther apart than the
/// noise, and it was refined by these alone: by 13 mm too little where it was 25 mm off.
#[test]
fn what_noise_took_off_a_dense_plane_is_not_taken_for_sparse() {
    let std = 0.011;
    for spacing in [0.003, 0.004] {
        let measured = noisy(&plane(0.4, spacing, 1).points, std, 7);
        let well_inside = |p: &Point3| p.x.abs() < 0.15 && p.y.abs() < 0.15;
        let refined: Vec<_> = refined(&measured, &isotropic(std, &measured))
            .into_iter()
            .filter(|(index, _)| well_inside(&measured[*index]))
            .collect();
        let is_far = |(index, _): &&(usize, Refined)| measured[*index].z.abs() > 1.5 * std;
        let far: Vec<_> = refined.iter().filter(is_far).collect();
        assert!(far.len() > 100, "{}", far.len());
        let rms = |of: &[&(usize, Refined)]| root_mean_square(of.iter().map(|r| r.1.point.mean.z));
        let (all, far) = (rms(&refined.iter().collect::<Vec<_>>()), rms(&far));
        assert!(all < 0.5 * std && far < 0.75 * std, "{spacing}: {all}, of those far off {far}");
        let standardised = root_mean_square(refined.iter().map(|(_, refined)| {
            refined.point.mean.z / refined.point.covariance.std_along(&Vector3::z())
        }));
        assert!(standardised < 1.15, "{spacing}: {standardised}");
    }
}

/// A post of this width (m) before a camera that looks along z, its front 2.5 m away, as pixels of a focal length of 610
/// see it.
fn post(width: f64, std: impl Fn(f64) -> f64) -> Vec<Point3> {
    let (focal, depth) = (610.0, 2.5);
    let columns = (0.5 * width / depth * focal) as i32;
    let pixels = (-columns..=columns).flat_map(|u| (-60..60).map(move |v| (u, v)));
    pixels
        .enumerate()
        .map(|(index, (u, v))| {
            let ray = Vector3::new(f64::from(u) / focal, f64::from(v) / focal, 1.0);
            Point3::from(ray * (depth + std(depth) * gaussian(11, index).x))
        })
        .collect()
}

/// Noise along rays is five times that across them: planes that the rays lie in, such as through a column of pixels,
/// passed for surfaces, since hardly anything misses them.
#[test]
fn a_post_faces_the_camera_that_sees_it_and_not_the_side() {
    let sensor: SensorModel = "stereo:0.095,610,0.1".parse().unwrap();
    let std = |depth: f64| depth * depth / (0.095 * 610.0) * 0.1;
    for width in [0.04, 0.08, 0.2] {
        let measured = post(width, std);
        let noise = sensor.covariances(&PointCloud::from_points(measured.clone())).unwrap();
        let refined = refined(&measured, &noise);
        let faces = |normal: Option<UnitVector3>| normal.is_some_and(|n| n.z.abs() > 0.9);
        let astray = refined.iter().filter(|(_, refined)| !faces(refined.normal)).count();
        assert!(20 * astray < refined.len(), "{width} m: {astray} of {}", refined.len());
    }
}

/// Things no wider than what the plane about them is told from: nobody looked for others beside their samples, so that
/// these were taken for samples of the plane that are so far off by chance, a fifth of what was far enough off.
#[test]
fn samples_of_a_thing_over_a_dense_plane_are_not_there_by_chance() {
    let (std, spacing, width) = (0.005, 0.002, 0.016);
    for high in [3.5, 4.0, 4.5] {
        let mut points = plane(0.32, spacing, 1).points;
        let is_near = |v: f64| (v.abs() - 0.04).abs() < 0.5 * width;
        let is_on_pin = |p: &Point3| is_near(p.x) && is_near(p.y);
        let of_pins: Vec<bool> = points.iter().map(is_on_pin).collect();
        points.iter_mut().filter(|p| is_on_pin(p)).for_each(|p| p.z = high * std);
        let measured = noisy(&points, std, 7);
        let heights: Vec<f64> = refined(&measured, &isotropic(std, &measured))
            .into_iter()
            .filter(|(index, _)| of_pins[*index] && measured[*index].z > 3.5 * std)
            .map(|(_, refined)| refined.point.mean.z / std)
            .collect();
        let lost = heights.iter().filter(|height| **height < 2.0).count();
        assert!(
            heights.len() > 80 && 12 * lost < heights.len(),
            "{high}: {lost} of {}",
            heights.len()
        );
    }
}
