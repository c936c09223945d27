//! Queries near contact and nothing else, for a profiler:
//! `valgrind --tool=callgrind target/release/examples/near_queries`.

use cloudtouch::{Query, QuerySettings};
use cloudtouch_benches::piano_room::{classes, piano, prepared, room};
use cloudtouch_geom::{Pose, Vector3, seed};

const POINTS: usize = 10_000;
const POSES: u64 = 100;
/// How far each pose is moved along every axis at most, m.
const MOVED: f64 = 0.02;

fn main() {
    let [room, piano] = [room(POINTS), piano(POINTS)]
        .map(|cloud| prepared(&cloud).refined().expect("ordinary noise"));
    let query = Query::new(QuerySettings::default()).expect("default settings");
    let [_, near, _] = classes();
    let (mut probabilities, mut solves) = (0.0, 0);
    for i in 0..POSES {
        let draw = |k| MOVED * (2.0 * seed::unit(seed::derive(i, k, 0)) - 1.0);
        let moved = Pose::from_translation(Vector3::new(draw(0), draw(1), draw(2)));
        let pose = moved.after(&near.pose.scene_from_object);
        let report = query.run(&room, &piano, &pose).expect("finite poses");
        probabilities += report.collision_probability;
        solves += report.stats.kernel_solves;
    }
    println!(
        "{POSES} queries, mean probability {:.3}, {solves} classifiers",
        probabilities / POSES as f64
    );
}
