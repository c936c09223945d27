//! What a check of a scene takes beside its pairs that are near, on one thread: a hundred clouds of a thousand points
//! and an arm of twelve links among them.

use std::sync::Arc;
use std::time::Instant;

use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Detail, Mesh, Query, QuerySettings, Scene};
use cloudtouch_geom::PointCloud;
use cloudtouch_testkit::workshop::{self, Workshop, workshop};

/// Each time is the least of so many.
const RUNS: usize = 30;

fn main() {
    let scene = of_workshop();
    let near = near_pairs(&scene);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    for detail in [Detail::Full, Detail::Verdict] {
        let query = query(detail);
        let whole = pool.install(|| least(|| drop(scene.check(&query))));
        let ask_near = || near.iter().for_each(|pair| drop(asked(&scene, &query, pair)));
        let alone = pool.install(|| least(ask_near));
        println!(
            "{detail:?}: {:.2} ms for the scene, {:.2} ms for its {} near pairs alone: {:.2} times",
            1e3 * whole,
            1e3 * alone,
            near.len(),
            whole / alone,
        );
    }
}

fn of_workshop() -> Scene {
    let Workshop { balls, link, links } = workshop();
    let mut all = Scene::default();
    let settings = CloudSettings::new(SensorModel::Isotropic { std: workshop::STD });
    for (name, points, place) in balls {
        let ball = Cloud::prepare(&PointCloud::from_points(points), &settings);
        all.add(name, ball.expect("a usable cloud"), place).expect("a new name");
    }
    let link = Arc::new(Body::from(Mesh::prepare(&link).expect("a box")));
    for (name, place) in &links {
        all.add(name, Arc::clone(&link), *place).expect("a new name");
    }
    for ends in links.windows(2) {
        all.allow(&ends[0].0, &ends[1].0).expect("two of the scene");
    }
    all
}

fn query(detail: Detail) -> Query {
    Query::new(QuerySettings { detail, ..QuerySettings::default() }).expect("default settings")
}

/// Pairs that may not touch and of which a query looks at points.
fn near_pairs(scene: &Scene) -> Vec<[&str; 2]> {
    let query = query(Detail::Full);
    let names: Vec<&str> = scene.names().collect();
    let pairs =
        names.iter().enumerate().flat_map(|(k, a)| names[k + 1..].iter().map(move |b| [*a, *b]));
    let may_touch = |[a, b]: &[&str; 2]| scene.is_allowed(a, b).expect("two of the scene");
    let is_near = |pair: &[&str; 2]| asked(scene, &query, pair).stats.leaf_pairs > 0;
    pairs.filter(|pair| !may_touch(pair) && is_near(pair)).collect()
}

fn asked(scene: &Scene, query: &Query, [a, b]: &[&str; 2]) -> cloudtouch::Report {
    let pose = scene.between(a, b).expect("two of the scene");
    let [a, b] = [a, b].map(|name| scene.body(name).expect("one of the scene"));
    query.run(a, b, &pose).expect("a finite pose")
}

/// Seconds.
fn least(work: impl Fn()) -> f64 {
    let times = (0..RUNS).map(|_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}
