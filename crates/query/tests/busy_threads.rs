//! Queries while all threads of the pool wait for something else: in a test of its own, for the pool is the process's.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use std::sync::{Arc, Mutex, mpsc};
use std::thread;
use std::time::Duration;

use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::{scene, surface};

/// A box of 12 cm with so much noise that a search goes on by a tree fitted to all of its surface.
fn blurred_box(seed: u64) -> Cloud {
    let samples = surface::sample_surface(&scene::cuboid([0.12; 3]), 5400, seed);
    let points: Vec<Point3> =
        add_noise(&surface::positions(&samples), NoiseKind::Gaussian, 0.02, seed);
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.02 });
    Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap()
}

/// What a query makes for all others of a cloud was made on all threads while these might wait for it: one query
/// beside a batch of others in the pool, all of them the first of a blurred cloud, never came back.
#[test]
fn a_query_waited_for_threads_that_may_wait_for_it() {
    let (a, b) = (blurred_box(1), blurred_box(2));
    let gate = Arc::new(Mutex::new(()));
    let closed = gate.lock().unwrap();
    let (say, said) = mpsc::channel();
    let waiting = gate.clone();
    rayon::spawn_broadcast(move |_| {
        say.send(()).unwrap();
        drop(waiting.lock());
    });
    said.iter().take(rayon::current_num_threads()).for_each(drop);
    let (answer, answered) = mpsc::channel();
    let asked = thread::spawn(move || {
        let query = Query::new(QuerySettings::default()).unwrap();
        let pose = Pose::from_translation(Vector3::new(0.0, 0.0, 0.13));
        answer.send(query.run(&a, &b, &pose)).unwrap();
    });
    let in_time = answered.recv_timeout(Duration::from_secs(120));
    drop(closed);
    asked.join().unwrap();
    let stats = in_time.expect("no thread of the pool is needed").unwrap().stats;
    // Else it did not come to the tree that is fitted.
    assert!(stats.leaf_pairs > 1_000, "{}", stats.leaf_pairs);
}
