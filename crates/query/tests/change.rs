//! A cloud that is changed answers as one prepared from the same points.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

mod common;

use cloudtouch::geom::{Covariance, Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{ChangeError, Cloud, CloudSettings, Judge, Mesh, Query, QuerySettings, Report};
use cloudtouch_testkit::scene;
use common::{measured, timeless, uniform};
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

    /// The first noise is below the spacing of the ball, where every point stands for itself; at the last
    /// a few stand for all.
    #[test]
    fn the_answers_are_those_of_a_fresh_cloud_to_the_bit(
        steps in steps(),
        std in prop::sample::select(vec![0.001, 0.004, 0.03]),
        is_refined in any::<bool>(),
        seed in any::<u64>(),
    ) {
        let by = settings(std);
        let mut points = corners();
        points.extend(measured(&scene::sphere(0.1, 3), 0.01, 0.001, seed));
        let mut changed = cloud(&points, &by);
        if is_refined {
            changed = changed.refined().unwrap();
        }
        for step in &steps {
            step.take(&mut changed, &mut points, 8, &by);
        }
        let mut fresh = cloud(&points, &by);
        if is_refined {
            fresh = fresh.refined().unwrap();
        }
        prop_assert!((0..points.len()).all(|i| changed.point(i) == points[i]));
        let query = Query::new(QuerySettings::default()).unwrap();
        prop_assert_eq!(answers(&query, &changed, seed), answers(&query, &fresh, seed));
    }

    /// Where the box grows or shrinks the changed cloud keeps its local frame, and rounds otherwise.
    #[test]
    fn in_a_frame_of_its_own_the_answers_are_those_of_a_fresh_cloud_up_to_rounding(
        steps in steps(),
        seed in any::<u64>(),
    ) {
        let by = settings(0.001);
        let mut points = measured(&scene::sphere(0.1, 3), 0.01, 0.001, seed);
        points.push(Point3::new(0.3, 0.1, 0.0));
        let mut changed = cloud(&points, &by);
        changed.remove(&[points.len() - 1]).unwrap();
        points.pop();
        for step in &steps {
            step.take(&mut changed, &mut points, 0, &by);
        }
        let fresh = cloud(&points, &by);
        let judge = Judge::default().without_classifier();
        // A search that ends early knows what came first.
        let usual = QuerySettings { stop_above: 1.0, ..QuerySettings::default() };
        let query = Query::new(QuerySettings { judge, ..usual }).unwrap();
        for (found, expected) in answers(&query, &changed, seed).iter().zip(answers(&query, &fresh, seed)) {
            let apart = (found.collision_probability - expected.collision_probability).abs();
            prop_assert!(apart <= 1e-9, "{apart}");
            prop_assert_eq!(found.verdict, expected.verdict);
        }
    }
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
    let query = Query::new(QuerySettings::default()).unwrap();
    let fresh = Cloud::prepare(&scan(&all), &by).unwrap();
    assert_eq!(answers(&query, &changed, 1), answers(&query, &fresh, 1));
    let gone: Vec<usize> = (100..all.len()).step_by(7).collect();
    changed.remove(&gone).unwrap();
    let left: Vec<Point3> =
        all.iter().enumerate().filter(|(i, _)| !gone.contains(i)).map(|(_, p)| *p).collect();
    let fresh = Cloud::prepare(&scan(&left), &by).unwrap();
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

/// Prints the work that a change takes beside preparing anew: `cargo test --release -p cloudtouch --test change --
/// --ignored --nocapture cost`.
#[test]
#[ignore = "measures time"]
fn cost_of_changing_one_point_in_a_hundred() {
    let by = settings(0.001);
    let points = measured(&scene::room(), 0.0302, 0.001, 1);
    let near = |i: &usize| (points[*i] - points[5000]).norm();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|i, j| near(i).total_cmp(&near(j)));
    let some: Vec<(usize, Point3)> = order
        .iter()
        .take(points.len() / 100)
        .map(|&i| (i, points[i] + Vector3::z() * 1e-3))
        .collect();
    let seconds = |work: &mut dyn FnMut()| {
        let start = cpu_seconds();
        work();
        cpu_seconds() - start
    };
    let mut changed = None;
    let prepare = seconds(&mut || changed = Some(cloud(&points, &by)));
    let mut changed = changed.unwrap();
    let lazy = seconds(&mut || assert!(changed.move_points(&some).is_ok()));
    let mut refined = None;
    let whole = seconds(&mut || refined = Some(cloud(&points, &by).refined().unwrap()));
    let mut refined = refined.unwrap();
    let mut change = None;
    let again = seconds(&mut || change = Some(refined.move_points(&some).unwrap()));
    println!(
        "{} points, {} moved: prepared in {:.0} ms, changed in {:.0} ms; refined in {:.0} ms, changed in {:.0} ms ({:.0} %), {:?}",
        points.len(),
        some.len(),
        1e3 * prepare,
        1e3 * lazy,
        1e3 * whole,
        1e3 * again,
        100.0 * again / whole,
        change.unwrap()
    );
}

/// What this process has worked, on all cores and whatever else the machine does, s.
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").expect("a Linux system");
    // Ticks of 10 ms, counted behind the name in brackets.
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap().split_whitespace().collect();
    [11, 12].map(|field| fields[field].parse::<f64>().unwrap()).iter().sum::<f64>() / 100.0
}
