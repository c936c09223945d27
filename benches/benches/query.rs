//! Whole queries on the piano room by class of pose: the first one on fresh clouds, which computes
//! the noise model where it looks, and repeated ones.
#![allow(missing_docs, reason = "criterion_group! makes a public function without documentation")]

use std::time::Duration;

use cloudtouch::{Cloud, Mode, Query, QuerySettings, Verdict};
use cloudtouch_benches::piano_room::{classes, piano, prepared, room};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};

const POINTS: usize = 10_000;

fn queries(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("query_10000x10000");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    let (room, piano) = (room(POINTS), piano(POINTS));
    for (name, mode) in [("calibrated", Mode::Calibrated), ("paper", Mode::Paper)] {
        let query = Query::new(QuerySettings::new(mode)).expect("default settings");
        let fresh = || [&room, &piano].map(|cloud| prepared(cloud, mode));
        group.bench_function(format!("{name}/prepare"), |bencher| bencher.iter(fresh));
        let [warm_room, warm_piano] = fresh();
        for class in classes() {
            let pose = &class.pose.scene_from_object;
            let run = || query.run(&warm_room, &warm_piano, pose);
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
                let run = |[room, piano]: [Cloud; 2]| {
                    let report = query.run(&room, &piano, pose);
                    // Handed back, so that freeing the clouds is not measured.
                    (report, room, piano)
                };
                bencher.iter_batched(fresh, run, BatchSize::PerIteration);
            });
        }
    }
}

criterion_group!(benches, queries);
criterion_main!(benches);
