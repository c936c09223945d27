//! How often a query asks for memory: in a test of its own, for the counter counts for the process.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use std::alloc::System;

use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Detail, Query, QuerySettings, Report, Verdict};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::{scene, surface};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

fn ball(seed: u64) -> Cloud {
    let samples = surface::sample_surface(&scene::sphere(0.1, 3), 2000, seed);
    let points: Vec<Point3> =
        add_noise(&surface::positions(&samples), NoiseKind::Gaussian, 0.001, seed);
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap().refined().unwrap()
}

/// A second query, and how often it asked for memory.
fn second(bodies: &[Cloud; 2], distance: f64) -> (Report, usize) {
    let settings = QuerySettings { detail: Detail::Probability, ..QuerySettings::default() };
    let query = Query::new(settings).unwrap();
    let pose = Pose::from_translation(Vector3::new(distance, 0.0, 0.0));
    let ask = || query.run(&bodies[0], &bodies[1], &pose).unwrap();
    ask();
    let region = Region::new(ALLOCATOR);
    let report = ask();
    let change = region.change();
    (report, change.allocations + change.reallocations)
}

/// One test: another at the same time would be counted too.
#[test]
fn a_second_query_asks_for_memory_by_the_leaves_it_visits_and_hardly_else() {
    let bodies = [ball(1), ball(2)];
    let (report, far) = second(&bodies, 0.5);
    assert_eq!((report.verdict, report.stats.leaf_pairs), (Verdict::Free, 0));
    // The pairs of boxes that wait, and those boxes.
    assert!(far <= 2, "{far}");
    let (report, near) = second(&bodies, 0.215);
    let pairs = report.stats.leaf_pairs;
    assert!(pairs > 10 && report.stats.kernel_solves == 0, "{:?}", report.stats);
    assert!(near <= 2 + 6 * pairs, "{near} in {pairs} pairs of leaves");
}
