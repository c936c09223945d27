//! How far a refinement looks: what is beyond may change, and changes nothing.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch_geom::{Covariance, Point3, Vector3, seed};
use cloudtouch_noise::{
    Combination, Neighborhoods, NoiseModel, NoiseSettings, Scratch, SensorNoise,
};

/// A sheet with a spacing of 1 cm.
fn sheet(count: u64) -> Vec<Point3> {
    let unit = |i: u64, k: u64| seed::unit(seed::derive(3, i, k));
    let side = 0.01 * (count as f64).sqrt();
    (0..count)
        .map(|i| Point3::new(side * unit(i, 0), side * unit(i, 1), 1e-3 * unit(i, 2)))
        .collect()
}

fn model(combination: Combination) -> NoiseModel {
    NoiseModel::new(NoiseSettings { combination, ..NoiseSettings::default() }).unwrap()
}

#[test]
fn points_beyond_the_reach_of_a_refinement_change_no_bit_of_it() {
    let points = sheet(1000);
    let noise = SensorNoise::uniform(Covariance::isotropic(1e-6), points.len());
    // The sums of eq. 17 run over points beyond the neighbours, too.
    for combination in
        [Combination::SurfacePosterior, Combination::Precision, Combination::Convolution]
    {
        let model = model(combination);
        let refined = |points: &[Point3], index: usize| {
            let (near, mut scratch) =
                (Neighborhoods::new(points.to_vec()).unwrap(), Scratch::default());
            let refined = model.refine(index, &near, &noise, f64::INFINITY, &mut scratch);
            (refined, scratch.reach())
        };
        for index in (0..points.len()).step_by(97) {
            let (expected, reach) = refined(&points, index);
            // Sixty neighbours of a spacing of 1 cm, at a corner on a quarter of the plane; or weights of twelve.
            let most = if combination == Combination::SurfacePosterior { 0.12 } else { 0.2 };
            assert!((0.03..most).contains(&reach), "{combination:?} {reach}");
            let is_beyond = |p: &Point3| (p - points[index]).norm() > reach * (1.0 + 1e-9);
            let away = |p: &Point3| if is_beyond(p) { p + Vector3::z() } else { *p };
            let changed: Vec<Point3> = points.iter().map(away).collect();
            assert_eq!(refined(&changed, index), (expected, reach), "{combination:?}");
        }
    }
}

/// What is as near as the last neighbour but for 1e-7 may come before it: a point 2e-8 beyond the reach did.
#[test]
fn a_point_as_near_as_the_last_neighbour_was_beyond_the_reach() {
    let model = model(Combination::SurfacePosterior);
    let height = |i: u64| 0.05 * seed::unit(seed::derive(9, i, 0));
    let place = |i: u64| Point3::new((i % 13) as f64 - 6.0, (i / 13) as f64 - 6.0, height(i));
    let mut points: Vec<Point3> = (0..169).map(place).collect();
    let middle = 84;
    let refined = |points: &[Point3]| {
        let noise = SensorNoise::uniform(Covariance::isotropic(1e-4), points.len());
        let near = Neighborhoods::new(points.to_vec()).unwrap();
        let mut scratch = Scratch::default();
        let refined = model.refine(middle, &near, &noise, f64::INFINITY, &mut scratch);
        (refined, scratch.reach())
    };
    let (expected, reach) = refined(&points);
    // Of those as near the first along x.
    let beyond = Vector3::new(-1.0, 0.0, 0.3).normalize() * reach * (1.0 + 2e-8);
    points.push(points[middle] + beyond);
    assert_eq!(refined(&points), (expected, reach));
}

#[test]
fn where_all_points_count_the_reach_has_no_end() {
    let model = model(Combination::SurfacePosterior);
    let points = sheet(1000);
    // Where the noise is far beyond the spacing, or there are too few neighbours, all of them count.
    let noise = SensorNoise::uniform(Covariance::isotropic(1e-2), points.len());
    let (near, mut scratch) = (Neighborhoods::new(points).unwrap(), Scratch::default());
    model.refine(7, &near, &noise, f64::INFINITY, &mut scratch);
    assert_eq!(scratch.reach(), f64::INFINITY);
    let few = Neighborhoods::new(sheet(40)).unwrap();
    let noise = SensorNoise::uniform(Covariance::isotropic(1e-6), 40);
    model.refine(7, &few, &noise, f64::INFINITY, &mut scratch);
    assert_eq!(scratch.reach(), f64::INFINITY);
}

#[test]
fn whether_any_position_is_within_a_distance() {
    let near = Neighborhoods::new(sheet(100)).unwrap();
    let place = near.points()[5] + Vector3::z();
    assert!(near.is_any_within(&place, 1.01) && !near.is_any_within(&place, 0.9));
    assert!(near.is_any_within(&near.points()[5], 0.0));
    let mut count = 0;
    near.visit_within(&near.points()[5], -1.0, |_| count += 1);
    assert!(count == 0 && !near.is_any_within(&near.points()[5], -1.0));
    assert!(!near.is_any_within(&Point3::new(f64::NAN, 0.0, 0.0), 1.0));
}
