//! Whole queries on the piano room by class of pose: the first one on fresh clouds, which computes
//! the noise model where it looks, and repeated ones.
#![allow(missing_docs, reason = "criterion_group! makes a public function without documentation")]

use std::time::Duration;

use cloudtouch::geom::{PointCloud, Pose};
use cloudtouch::{
    Judge, PaperQuery, PaperSettings, Query, QueryError, QuerySettings, Report, Verdict,
};
use cloudtouch_benches::piano_room::{classes, piano, prepared, prepared_by_the_paper, room};
use criterion::measurement::WallTime;
use criterion::{BatchSize, BenchmarkGroup, Criterion, criterion_group, criterion_main};

const POINTS: usize = 10_000;

fn queries(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("query_10000x10000");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    let query = Query::new(QuerySettings::default()).expect("default settings");
    measure(&mut group, "calibrated", prepared, |a, b, pose| query.run(a, b, pose));
    // Gaps of pieces and crossings of edges through discs, and no classifier.
    let judge = Judge::default().without_classifier();
    let query = Query::new(QuerySettings { judge, ..Default::default() }).expect("good settings");
    measure(&mut group, "geometry", prepared, |a, b, pose| query.run(a, b, pose));
    let query = PaperQuery::new(PaperSettings::default()).expect("default settings");
    measure(&mut group, "paper", prepared_by_the_paper, |a, b, pose| query.run(a, b, pose));
}

/// One path: preparation, and queries of every class, first and repeated.
fn measure<C>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    prepare: impl Fn(&PointCloud) -> C,
    ask: impl Fn(&C, &C, &Pose) -> Result<Report, QueryError>,
) {
    let (room, piano) = (room(POINTS), piano(POINTS));
    let fresh = || [&room, &piano].map(&prepare);
    group.bench_function(format!("{name}/prepare"), |bencher| bencher.iter(fresh));
    let [warm_room, warm_piano] = fresh();
    for class in classes() {
        let pose = &class.pose.scene_from_object;
        let run = || ask(&warm_room, &warm_piano, pose);
        let report = run().expect("finite poses");
        match class.name {
            "far" => assert_eq!(report.verdict, Verdict::Free),
            "deep" => assert_eq!(report.verdict, Verdict::InCollision),
            // A fifth of the spacing apart: any verdict will do, but not without a look.
            _ => assert!(report.stats.leaf_pairs > 0, "{:?}", report.stats),
        }
        group.bench_function(format!("{name}/{}/repeated", class.name), |bencher| {
            bencher.iter(run);
        });
        group.bench_function(format!("{name}/{}/first", class.name), |bencher| {
            let run = |[room, piano]: [C; 2]| {
                let report = ask(&room, &piano, pose);
                // Handed back, so that freeing the clouds is not measured.
                (report, room, piano)
            };
            bencher.iter_batched(fresh, run, BatchSize::PerIteration);
        });
    }
}

criterion_group!(benches, queries);
criterion_main!(benches);
