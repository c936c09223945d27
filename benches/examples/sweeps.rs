//! What a sweep takes beside the costliest query on its way: a box and a table, as clouds and as meshes, far apart,
//! along one another, and down to contact and into it.

use std::time::Instant;

use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Mesh, Path, Query, QuerySettings};
use cloudtouch_geom::{PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch_testkit::measured::measured;
use cloudtouch_testkit::scene;

/// Each time is the least of so many.
const RUNS: usize = 5;
const TOLERANCE: f64 = 0.01;

fn main() {
    let query = Query::new(QuerySettings::default()).expect("default settings");
    let (table, object) = (scene::cuboid([0.6, 0.6, 0.02]), scene::cuboid([0.1, 0.08, 0.12]));
    for kinds in [["cloud", "cloud"], ["cloud", "mesh"], ["mesh", "cloud"], ["mesh", "mesh"]] {
        let bodies = [body(kinds[0], &table, 14), body(kinds[1], &object, 15)];
        for (name, path) in moves() {
            println!("{} and {}, {name}: {}", kinds[0], kinds[1], cost(&query, &bodies, &path));
        }
    }
}

fn body(kind: &str, shape: &TriangleMesh, seed: u64) -> Body {
    const STD: f64 = 0.001;
    if kind == "mesh" {
        return Mesh::prepare(shape).expect("a closed mesh").into();
    }
    let mut settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
    settings.tree.max_leaf_points = 32;
    settings.tree.min_leaf_points = 8;
    let points = PointCloud::from_points(measured(shape, 0.005, STD, seed));
    Cloud::prepare(&points, &settings).expect("a usable cloud").into()
}

fn moves() -> impl Iterator<Item = (&'static str, Path)> {
    let at = |x: f64, z: f64| Pose::from_translation(Vector3::new(x, 0.0, z));
    let turned =
        |x: f64, yaw: f64| Pose::from_translation_rpy(Vector3::new(x, 0.0, 0.08), [0.0, 0.0, yaw]);
    let all = [
        ("far away", [at(0.0, 0.5), at(0.1, 0.5)]),
        ("2 cm above, along", [at(0.0, 0.09), at(0.1, 0.09)]),
        ("1 cm above, along", [at(0.0, 0.08), at(0.1, 0.08)]),
        ("1 cm above, turning", [turned(0.0, 0.0), turned(0.1, 0.5)]),
        ("down to 1 cm", [at(0.0, 0.18), at(0.0, 0.08)]),
        ("down to contact", [at(0.0, 0.17), at(0.0, 0.07)]),
        ("down into it", [at(0.0, 0.12), at(0.0, 0.02)]),
    ];
    all.into_iter().map(|(name, [from, to])| (name, Path::linear(&from, &to).expect("two poses")))
}

fn cost(query: &Query, [a, b]: &[Body; 2], path: &Path) -> String {
    let sweep = || query.sweep(a, b, path, TOLERANCE).expect("finite poses");
    let all = least(|| drop(sweep()));
    let of_one = |k: u32| {
        let pose = path.pose(0.05 * f64::from(k));
        least(|| drop(query.run(a, b, &pose).expect("a finite pose")))
    };
    let costliest = (0..=20).map(of_one).fold(0.0, f64::max);
    let swept = sweep();
    format!(
        "{all:.0} µs, {:.1} times the costliest query ({costliest:.0} µs); {} poses, {} stretches, bounds {:.3?}, \
         free until {:.3}",
        all / costliest,
        swept.stats.poses,
        swept.stats.stretches,
        swept.bounds,
        swept.certified_free_until,
    )
}

/// Microseconds.
fn least(work: impl Fn()) -> f64 {
    let times = (0..RUNS).map(|_| {
        let start = Instant::now();
        work();
        1e6 * start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}
