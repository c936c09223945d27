//! A cloud that is changed answers as one prepared from the same points.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use crate::common::{measured, timeless, uniform};
use cloudtouch::geom::{Covariance, Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{ChangeError, Cloud, CloudSettings, Judge, Mesh, Query, QuerySettings, Report};
use cloudtouch_testkit::scene;
use proptest::prelude::*;

/// Corners of a box that nothing leaves: its middle stays.
fn corners() -> Vec<Point3> {
    let side = |bit: usize| if bit == 0 { -0.4 } else { 0.4 };
    (0..8).map(|i| Point3::new(side(i & 1), side(i >> 1 & 1), side(i >> 2 & 1))).collect()
}

fn settings(std: f64) -> CloudSettings {
    CloudSettings::new(SensorModel::Isotropic { std })
}

fn cloud(points: &[Point3], settings: &CloudSettings) -> Cloud {
    Cloud::prepare(&PointCloud::from_points(points.to_vec()), settings).unwrap()
}

fn finger() -> Mesh {
    Mesh::prepare(&scene::cuboid([0.05, 0.04, 0.1])).unwrap()
}

/// Poses of the finger about a ball of 10 cm, and in it.
fn poses(seed: u64) -> impl Iterator<Item = Pose> {
    (0..6).map(move |k| {
        let unit = |n: u64| 2.0 * uniform(seed, 10 * k + n) - 1.0;
        let way =
            Vector3::new(unit(0), unit(1), unit(2)).normalize() * (0.1 + 0.08 * unit(3).abs());
        Pose::from_translation_rpy(way, [3.0 * unit(4), unit(5), 3.0 * unit(6)])
    })
}

fn answers(query: &Query, cloud: &Cloud, seed: u64) -> Vec<Report> {
    let finger = finger();
    poses(seed).map(|pose| timeless(&query.run(cloud, &finger, &pose).unwrap())).collect()
}

/// A change of a cloud, beside the list of its points.
#[derive(Debug, Clone)]
enum Step {
    Insert { count: usize, seed: u64 },
    Remove { every: usize, from: usize },
    Move { every: usize, by: f64 },
    Ask(u64),
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let step = prop_oneof![
        (1..80_usize, any::<u64>()).prop_map(|(count, seed)| Step::Insert { count, seed }),
        (2..40_usize, 0..40_usize).prop_map(|(every, from)| Step::Remove { every, from }),
        (5..200_usize, -0.02..0.02_f64).prop_map(|(every, by)| Step::Move { every, by }),
        any::<u64>().prop_map(Step::Ask),
    ];
    prop::collection::vec(step, 1..7)
}

impl Step {
    /// Does it to a cloud and to the list of its points; the first `fixed` are left alone.
    fn take(&self, cloud: &mut Cloud, points: &mut Vec<Point3>, fixed: usize, by: &CloudSettings) {
        match *self {
            Self::Insert { count, seed } => {
                let unit = |i: usize, k: usize| 2.0 * uniform(seed, (3 * i + k) as u64) - 1.0;
                let near = |i: usize| Vector3::new(unit(i, 0), unit(i, 1), unit(i, 2)).normalize();
                let added: Vec<Point3> =
                    (0..count).map(|i| Point3::from(near(i) * (0.1 + 0.01 * unit(i, 1)))).collect();
                let scan = PointCloud::from_points(added.clone());
                assert_eq!(cloud.insert(&scan, by).unwrap().inserted, count);
                points.extend(added);
            }
            Self::Remove { every, from } => {
                let gone: Vec<usize> = (fixed + from..points.len()).step_by(every).collect();
                if gone.len() + 100 > points.len() {
                    return;
                }
                assert_eq!(cloud.remove(&gone).unwrap().removed, gone.len());
                let mut index = 0..;
                points.retain(|_| !gone.contains(&index.next().unwrap()));
            }
            Self::Move { every, by } => {
                let chosen = (fixed..points.len()).step_by(every);
                let moves: Vec<(usize, Point3)> =
                    chosen.map(|i| (i, points[i] + Vector3::new(by, -by, 0.5 * by))).collect();
                assert_eq!(cloud.move_points(&moves).unwrap().moved, moves.len());
                moves.iter().for_each(|(i, place)| points[*i] = *place);
            }
            Self::Ask(seed) => {
                drop(answers(&Query::new(QuerySettings::default()).unwrap(), cloud, seed))
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    /// Built anew, or where samples are denser than their noise, which is built anew at each change.
    #[test]
    fn the_answers_of_a_rebuilt_cloud_are_those_of_a_fresh_one_to_the_bit(
        steps in steps(),
        std in prop::sample::select(vec![0.001, 0.004, 0.03]),
        is_refined in any::<bool>(),
        seed in any::<u64>(),
    ) {
        let (mut changed, fresh) = changed_and_fresh(&steps, std, corners(), is_refined, seed);
        if std < 0.03 {
            prop_assert!(changed.rebuild().unwrap().is_rebuilt);
        }
        let query = Query::new(QuerySettings::default()).unwrap();
        prop_assert_eq!(answers(&query, &changed, seed), answers(&query, &fresh, seed));
    }

    /// Where the box grows or shrinks the changed cloud keeps its local frame, and rounds otherwise.
    #[test]
    fn in_a_frame_of_its_own_a_rebuilt_cloud_answers_as_a_fresh_one_up_to_rounding(
        steps in steps(),
        seed in any::<u64>(),
    ) {
        let (mut changed, fresh) = changed_and_fresh(&steps, 0.001, Vec::new(), false, seed);
        changed.rebuild().unwrap();
        let both = [&changed, &fresh].map(|cloud| by_geometry(cloud, seed));
        for (found, expected) in both[0].iter().zip(&both[1]) {
            let apart = (found.collision_probability - expected.collision_probability).abs();
            prop_assert!(apart <= 1e-9, "{apart}");
            prop_assert_eq!(found.verdict, expected.verdict);
        }
    }

    /// Where no sample is lonely, as on a ball that is sampled evenly, nothing differs, but where the finger is
    /// clearly inside of it how much of the crossings is seen before that is known (seen: 3e-9 of P).
    #[test]
    fn where_no_sample_is_lonely_answers_are_those_of_a_fresh_cloud(
        changes in prop::collection::vec((0..1500_usize, 1..12_usize), 1..5),
        is_refined in any::<bool>(),
        seed in any::<u64>(),
    ) {
        let by = settings(0.001);
        // A Fibonacci lattice, a centimetre from sample to sample.
        let place = |i: usize| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / 1600.0;
            let (turn, off) = (2.399_963_229_728_653 * i as f64, 1e-3 * uniform(seed, i as u64));
            let flat = (1.0 - z * z).sqrt();
            Point3::from(Vector3::new(flat * turn.cos(), flat * turn.sin(), z) * (0.1128 + off))
        };
        let mut points: Vec<Point3> = (0..1600).map(place).collect();
        let made = |points: &[Point3]| {
            let cloud = cloud(points, &by);
            if is_refined { cloud.refined().unwrap() } else { cloud }
        };
        let mut changed = made(&points);
        for (at, count) in changes {
            let moves: Vec<(usize, Point3)> =
                (at..at + count).map(|i| (i, points[i] + Vector3::new(5e-4, -5e-4, 5e-4))).collect();
            changed.move_points(&moves).unwrap();
            moves.iter().for_each(|(i, place)| points[*i] = *place);
            // One goes, and another comes near its place.
            let place = points.remove(at / 2) + Vector3::z() * 5e-4;
            changed.remove(&[at / 2]).unwrap();
            let scan = PointCloud::from_points(vec![place]);
            prop_assert!(!changed.insert(&scan, &by).unwrap().is_rebuilt);
            points.push(place);
        }
        for apart in apart(&changed, &made(&points), seed) {
            prop_assert!(apart <= 1e-8, "{apart}");
        }
    }
}

/// A ball that changed by steps, and one prepared from the same points.
fn changed_and_fresh(
    steps: &[Step],
    std: f64,
    fixed: Vec<Point3>,
    is_refined: bool,
    seed: u64,
) -> (Cloud, Cloud) {
    let by = settings(std);
    let (mut points, fixed) = (fixed.clone(), fixed.len());
    points.extend(measured(&scene::sphere(0.1, 3), 0.01, 0.001, seed));
    let made = |points: &[Point3]| {
        let cloud = cloud(points, &by);
        if is_refined { cloud.refined().unwrap() } else { cloud }
    };
    let mut changed = made(&points);
    steps.iter().for_each(|step| step.take(&mut changed, &mut points, fixed, &by));
    assert!((0..points.len()).all(|i| changed.point(i) == points[i]));
    (changed, made(&points))
}

/// Answers without a classifier and at the end of each search: a search that ends early knows what came first.
fn by_geometry(cloud: &Cloud, seed: u64) -> Vec<Report> {
    let judge = Judge::default().without_classifier();
    let settings = QuerySettings { judge, stop_above: 1.0, ..QuerySettings::default() };
    answers(&Query::new(settings).unwrap(), cloud, seed)
}

/// How far such probabilities of two clouds are apart.
fn apart(changed: &Cloud, fresh: &Cloud, seed: u64) -> Vec<f64> {
    let pairs = by_geometry(changed, seed).into_iter().zip(by_geometry(fresh, seed));
    pairs.map(|(p, q)| (p.collision_probability - q.collision_probability).abs()).collect()
}

/// Elsewhere the tree is changed in place. The limit to the spacing of lonely samples is told from the boxes of
/// the tree, and so may differ from that in a fresh cloud: how often that matters, over histories that throw
/// samples 2 cm off a ball sampled every 1 cm.
#[test]
fn all_but_a_few_answers_are_those_of_a_fresh_cloud_up_to_rounding() {
    let mut all = Vec::new();
    for seed in 0..60 {
        let pick = |k: u64, count: usize| (uniform(seed, k) * count as f64) as usize;
        let steps: Vec<Step> = (0..4)
            .map(|k| match pick(k, 3) {
                0 => Step::Insert { count: 1 + pick(10 + k, 80), seed: seed + k },
                1 => Step::Remove { every: 2 + pick(10 + k, 38), from: pick(20 + k, 40) },
                _ => Step::Move {
                    every: 5 + pick(10 + k, 195),
                    by: 0.04 * uniform(seed, 20 + k) - 0.02,
                },
            })
            .collect();
        let fixed = if seed % 2 == 0 { corners() } else { Vec::new() };
        let (changed, fresh) = changed_and_fresh(&steps, 0.001, fixed, seed % 3 == 0, seed);
        all.extend(apart(&changed, &fresh, seed));
    }
    let share = |most: f64| all.iter().filter(|d| **d <= most).count() as f64 / all.len() as f64;
    let worst = all.iter().copied().fold(0.0, f64::max);
    println!(
        "within 1e-9: {:.3}, 1e-6: {:.3}, 1e-3: {:.3}, worst {worst:.4}",
        share(1e-9),
        share(1e-6),
        share(1e-3)
    );
    assert!(share(1e-6) >= 0.95 && share(1e-3) >= 0.99);
}

#[test]
fn noise_of_each_point_comes_goes_and_moves_with_it() {
    let points = measured(&scene::sphere(0.1, 3), 0.01, 0.001, 5);
    let scan = |points: &[Point3]| PointCloud {
        covariances: Some(
            points
                .iter()
                .map(|p| Covariance::isotropic((0.001 + 0.002 * p.z.abs()).powi(2)))
                .collect(),
        ),
        ..PointCloud::from_points(points.to_vec())
    };
    let by = CloudSettings::new(SensorModel::PerPoint);
    let all: Vec<Point3> = corners().into_iter().chain(points).collect();
    let (first, second) = all.split_at(500);
    let mut changed = Cloud::prepare(&scan(first), &by).unwrap();
    changed.insert(&scan(second), &by).unwrap();
    let fresh = Cloud::prepare(&scan(&all), &by).unwrap();
    assert!(apart(&changed, &fresh, 1).iter().all(|apart| *apart <= 1e-6));
    let gone: Vec<usize> = (100..all.len()).step_by(7).collect();
    changed.remove(&gone).unwrap();
    let left: Vec<Point3> =
        all.iter().enumerate().filter(|(i, _)| !gone.contains(i)).map(|(_, p)| *p).collect();
    let fresh = Cloud::prepare(&scan(&left), &by).unwrap();
    assert!(apart(&changed, &fresh, 2).iter().all(|apart| *apart <= 1e-6));
    changed.rebuild().unwrap();
    let query = Query::new(QuerySettings::default()).unwrap();
    assert_eq!(answers(&query, &changed, 2), answers(&query, &fresh, 2));
    assert_eq!(changed.rows().len(), left.len());
    assert_eq!((changed.rows()[100], changed.rows()[499]), (101, 566));
}

#[test]
fn the_surface_far_from_a_change_is_kept_and_near_it_computed_anew() {
    let by = settings(0.001);
    let mut points = corners();
    points.extend(measured(&scene::plane_patch(0.7), 0.01, 0.001, 3));
    let mut changed = cloud(&points, &by).refined().unwrap();
    let hole: Vec<usize> = (8..points.len()).filter(|&i| points[i].coords.norm() < 0.04).collect();
    let change = changed.remove(&hole).unwrap();
    assert_eq!(change.surfaces_kept + change.surfaces_lost, points.len());
    // Sixty neighbours are within five spacings: of 70 by 70 samples those within nine are concerned.
    let concerned = points.iter().filter(|p| p.coords.norm() < 0.12).count();
    assert!((hole.len()..concerned + 60).contains(&change.surfaces_lost), "{change:?} {concerned}");
    assert!(!change.is_recentred);
    // Far away the frame is laid anew.
    let far = PointCloud::from_points(points.iter().map(|p| p + Vector3::x() * 50.0).collect());
    let mut moved = cloud(&points, &by);
    moved.insert(&far, &by).unwrap();
    let old: Vec<usize> = (0..points.len()).collect();
    let change = moved.remove(&old).unwrap();
    assert!(change.is_recentred && change.surfaces_kept == 0, "{change:?}");
}

#[test]
fn what_cannot_be_meant_is_refused_and_leaves_the_cloud_as_it_was() {
    let by = settings(0.001);
    let points = measured(&scene::sphere(0.1, 3), 0.02, 0.001, 5);
    let count = points.len();
    let mut changed = cloud(&points, &by);
    let gone = changed.remove(&[3, count]);
    assert_eq!(gone, Err(ChangeError::NoSuchPoint { index: count, count }));
    assert_eq!(changed.remove(&[3, 4, 3]), Err(ChangeError::Twice { index: 3 }));
    let all: Vec<usize> = (0..count).collect();
    assert_eq!(changed.remove(&all), Err(ChangeError::NothingLeft { count }));
    let nowhere = changed.move_points(&[(2, Point3::new(0.0, f64::NAN, 0.0))]);
    assert!(matches!(nowhere, Err(ChangeError::Coordinate { index: 2, value }) if value.is_nan()));
    let far = changed.move_points(&[(2, Point3::new(0.0, -1e11, 0.0))]);
    assert_eq!(far, Err(ChangeError::Coordinate { index: 2, value: -1e11 }));
    let nothing = PointCloud::from_points(vec![Point3::new(f64::NAN, 0.0, 0.0)]);
    assert!(matches!(changed.insert(&nothing, &by), Err(ChangeError::Prepare(_))));
    let loose = PointCloud::from_points(points.clone());
    assert_eq!(changed.replace_frame(&loose, &by), Err(ChangeError::NotAnImage));
    let query = Query::new(QuerySettings::default()).unwrap();
    assert_eq!(answers(&query, &changed, 1), answers(&query, &cloud(&points, &by), 1));
}

/// It counted as a second look at the same surface: touching poses read free.
#[test]
fn a_scan_that_is_in_the_cloud_already_was_taken_for_another() {
    let ball = measured(&scene::sphere(0.1, 3), 0.01, 0.002, 5);
    let scan = PointCloud::from_points(ball.clone());
    let mut changed = cloud(&ball, &settings(0.002));
    let count = ball.len();
    let again = changed.insert(&scan, &settings(0.002));
    assert_eq!(again, Err(ChangeError::RepeatedScan { count }));
    assert_eq!(changed.len(), count);
    // Another look is welcome, and so is what had gone.
    let other = PointCloud::from_points(measured(&scene::sphere(0.1, 3), 0.01, 0.002, 6));
    changed.insert(&other, &settings(0.002)).unwrap();
    changed.remove(&(0..count).collect::<Vec<_>>()).unwrap();
    assert_eq!(changed.insert(&scan, &settings(0.002)).unwrap().inserted, count);
}
