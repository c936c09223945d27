//! The same question gives the same bits: again, on more threads, after other questions.

use std::sync::Arc;

use crate::common::{AnyQuery, MODES, Scan, at, mesh, query, scan, scenes, timeless};
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch::{Mode, Report};
use cloudtouch_testkit::scene;

fn bodies(mode: Mode) -> (Scan, Scan) {
    let floor = scan(&scene::plane_patch(0.4), 0.015, 0.003, 1, mode);
    let ball = scan(&scene::sphere(0.1, 3), 0.012, 0.002, 2, mode);
    (floor, ball)
}

fn poses() -> Vec<Pose> {
    (0..24)
        .map(|i| {
            let t = f64::from(i);
            let offset = Vector3::new(0.01 * t - 0.12, 0.005 * t, 0.08 + 0.003 * t);
            Pose::from_translation_rpy(offset, [0.3 * t, 0.1 * t, -0.2 * t])
        })
        .collect()
}

/// Reports of a batch on a pool of this many threads, with bodies nobody has queried before.
fn batch(mode: Mode, query: &AnyQuery, threads: usize) -> Vec<Report> {
    let (floor, ball) = bodies(mode);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a thread pool");
    let reports = pool.install(|| query.run_batch(&floor, &ball, &poses()));
    reports.into_iter().map(|r| timeless(&r.expect("finite poses"))).collect()
}

#[test]
fn twice_the_same_bits() {
    for mode in MODES {
        let query = query(mode);
        let run = || -> Vec<Report> {
            let (a, b) = bodies(mode);
            poses().iter().map(|pose| timeless(&query.run(&a, &b, pose).unwrap())).collect()
        };
        // Exact equality of every number.
        assert_eq!(run(), run(), "{mode:?}");
    }
}

#[test]
fn one_thread_or_four() {
    for mode in MODES {
        let query = query(mode);
        let (one, four) = (batch(mode, &query, 1), batch(mode, &query, 4));
        assert_eq!(one.len(), poses().len());
        for (i, (one, four)) in one.iter().zip(&four).enumerate() {
            assert_eq!(one, four, "{mode:?}, pose {i}");
        }
        let undecisive = one.iter().filter(|r| (0.01..0.99).contains(&r.collision_probability));
        assert!(undecisive.count() > 0, "{mode:?}: only easy poses prove nothing");
    }
}

#[test]
fn a_batch_is_its_single_queries_in_order() {
    let query = query(Mode::Calibrated);
    let (a, b) = bodies(Mode::Calibrated);
    let reports = query.run_batch(&a, &b, &poses());
    for (pose, report) in poses().iter().zip(reports) {
        let single = query.run(&a, &b, pose).unwrap();
        assert_eq!(timeless(&single), timeless(&report.unwrap()));
    }
}

/// Leaves are prepared by the query that first needs them, and it does not matter which that is.
#[test]
fn the_order_of_earlier_queries_does_not_matter() {
    for mode in MODES {
        let query = query(mode);
        let answers = |order: &[usize]| -> Vec<Report> {
            let (a, b) = bodies(mode);
            let mut reports: Vec<(usize, Report)> = order
                .iter()
                .map(|&i| (i, timeless(&query.run(&a, &b, &poses()[i]).unwrap())))
                .collect();
            reports.sort_by_key(|(i, _)| *i);
            reports.into_iter().map(|(_, report)| report).collect()
        };
        let forward: Vec<usize> = (0..poses().len()).collect();
        let backward: Vec<usize> = (0..poses().len()).rev().collect();
        assert_eq!(answers(&forward), answers(&backward), "{mode:?}");
    }
}

#[test]
fn the_second_query_prepares_no_leaf() {
    let query = query(Mode::Calibrated);
    let (a, b) = bodies(Mode::Calibrated);
    let pose = poses()[8];
    let first = query.run(&a, &b, &pose).unwrap();
    let second = query.run(&a, &b, &pose).unwrap();
    assert!(first.stats.leaves_prepared > 0);
    assert_eq!(second.stats.leaves_prepared, 0);
}

#[test]
fn with_a_mesh_too() {
    let query = query(Mode::Calibrated);
    let ball = mesh(&scene::sphere(0.1, 3));
    let run = |threads: usize| -> Vec<Report> {
        let (floor, _) = bodies(Mode::Calibrated);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let reports = pool.install(|| query.run_batch(&floor, &ball, &poses()));
        reports.into_iter().map(|r| timeless(&r.unwrap())).collect()
    };
    assert_eq!(run(1), run(4));
}

/// As threads hold them, without a dereference.
#[test]
fn a_query_takes_bodies_that_are_shared() {
    let cube = Arc::new(mesh(&scene::cuboid([0.1; 3])));
    let ball = Arc::new(scenes::cloud(&scene::sphere(0.05, 2), 0.01, 0.001, 1));
    let (query, pose) = (scenes::query(), at(0.12, 0.0, 0.0));
    let shared = query.run(&cube, &ball, &pose).expect("a finite pose");
    let borrowed = query.run(&*cube, &*ball, &pose).expect("a finite pose");
    assert_eq!(shared.collision_probability.to_bits(), borrowed.collision_probability.to_bits());
}
