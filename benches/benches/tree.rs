//! OBB trees: build, refit, insertion, and the traversals of two of them, by box tests alone.
#![allow(missing_docs, reason = "criterion_group! makes a public function without documentation")]

use std::hint::black_box;
use std::time::Duration;

use cloudtouch_benches::sphere::sphere;
use cloudtouch_bvh::{
    Flow, Sought, SurfaceFlow, Traversal, TraversalSettings, Tree, TreeSettings, traverse,
    visit_surfaces,
};
use cloudtouch_geom::{Pose, Vector3};
use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};

const INSERTED: u64 = 1000;

fn changes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("tree");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    let settings = TreeSettings::default();
    for count in [10_000, 200_000] {
        let cloud = sphere(1, count, 0.003);
        let tree = Tree::build(cloud.clone(), &settings).expect("a tree");
        assert_eq!(tree.len() as u64, count);
        group.bench_function(BenchmarkId::new("build", count), |bencher| {
            let build = |points| Tree::build(points, &settings);
            bencher.iter_batched(|| cloud.clone(), build, BatchSize::LargeInput);
        });
        let mut refitted = tree.clone();
        group.bench_function(BenchmarkId::new("refit", count), |bencher| {
            bencher.iter(|| refitted.refit(black_box(&cloud)));
        });
        let extra = sphere(3, INSERTED, 0.003);
        group.bench_function(BenchmarkId::new("insert_1000", count), |bencher| {
            let insert = |mut tree: Tree| {
                extra.iter().try_for_each(|point| tree.insert(*point).map(drop)).map(|()| tree)
            };
            bencher.iter_batched(|| tree.clone(), insert, BatchSize::LargeInput);
        });
    }
}

fn pairs(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("traverse_10000x10000");
    group.sample_size(20).measurement_time(Duration::from_secs(1));
    let settings = TreeSettings::default();
    for std in [0.002, 0.01] {
        let [a, b] = [1, 2]
            .map(|stream| Tree::build(sphere(stream, 10_000, std), &settings).expect("a tree"));
        // Distance of the centres of two spheres 1 m across.
        for (gap, offset) in [("3m", 4.0), ("2cm", 1.02), ("0cm", 1.0), ("-5cm", 0.95)] {
            let pose = Pose::from_translation(Vector3::new(offset, 0.0, 0.0));
            for kind in [Traversal::Certified, Traversal::GapAware, Traversal::Paper] {
                let settings = TraversalSettings { kind, ..Default::default() };
                let run = || traverse(&a, &b, &pose, &settings, 0, |_| Flow::Continue);
                let outcome = run().expect("finite poses");
                if kind == Traversal::Certified {
                    assert_eq!(outcome.leaf_pairs > 0, gap != "3m", "{gap}: {outcome:?}");
                }
                let id = format!("{kind:?}/std_{std}/gap_{gap}").to_lowercase();
                group.bench_function(id, |bencher| bencher.iter(run));
            }
        }
    }
}

/// The search of the default path, which sorts pairs by deviations.
fn surfaces(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("visit_surfaces_10000x10000");
    group.sample_size(20).measurement_time(Duration::from_secs(1));
    let settings = TreeSettings::default();
    let [a, b] =
        [1, 2].map(|stream| Tree::build(sphere(stream, 10_000, 0.002), &settings).expect("a tree"));
    let sought = Sought { within: 6.0, margin: 0.0, crossings: true, drift: None };
    for (gap, offset) in [("3m", 4.0), ("2cm", 1.02), ("0cm", 1.0), ("-5cm", 0.95)] {
        let pose = Pose::from_translation(Vector3::new(offset, 0.0, 0.0));
        let run = || visit_surfaces((&a, &b), &pose, sought, |_| SurfaceFlow::Within(6.0));
        let outcome = run().expect("finite poses");
        assert_eq!(outcome.leaf_pairs > 0, gap.contains("cm"), "{gap}: {outcome:?}");
        group.bench_function(BenchmarkId::new("gap", gap), |bencher| bencher.iter(run));
    }
}

criterion_group!(benches, changes, pairs, surfaces);
criterion_main!(benches);
