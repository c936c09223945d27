//! What the pixels of a depth image cost, and what they bring: frames of 640 x 480 pixels of household objects on a
//! table, by every column and row, every second of them and so on; ten poses of a gripper are asked of each, first
//! queries all of them, on one thread.

use std::time::Instant;

use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, FilterSettings, Mesh, Query, QuerySettings, Verdict};
use cloudtouch_testkit::family::{Family, Side};
use cloudtouch_testkit::noise::NoiseKind;

/// Scenes, each with a frame of its own, and poses asked of it.
const SCENES: u64 = 20;
const POSES: usize = 10;
/// About as many returns as a camera of 640 x 480 pixels has.
const RETURNS: usize = 300_000;
/// Standard deviation of the depth at 1 m, growing with its square, m.
const DEPTH_STD: f64 = 0.002;

/// Of all frames that were thinned alike.
#[derive(Default)]
struct Answers {
    returns: usize,
    prepare: Vec<f64>,
    ask: Vec<f64>,
    squared_errors: f64,
    asked: usize,
    collisions_free: usize,
    free_in_collision: usize,
    undecided: usize,
}

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("no pool yet");
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let filter = FilterSettings::for_sensor(&SensorModel::Kinect);
    let settings = CloudSettings { filter, ..CloudSettings::new(SensorModel::PerPoint) };
    let mut thinned: [Answers; 5] = Default::default();
    for seed in 0..SCENES {
        let scene = Family::Tabletop.scene(seed);
        let frame = scene.observe(Side::A, RETURNS, NoiseKind::Gaussian, DEPTH_STD, seed).cloud;
        let gripper = Mesh::prepare(scene.b.mesh()).expect("a gripper");
        let poses = scene.poses(POSES, seed);
        for (every, answers) in (1..).zip(&mut thinned) {
            let frame = frame.every(every, every).expect("an image");
            let start = Instant::now();
            let cloud = Cloud::prepare(&frame, &settings).expect("a usable frame");
            answers.prepare.push(start.elapsed().as_secs_f64());
            answers.returns += cloud.len();
            let start = Instant::now();
            let said =
                poses.iter().map(|pose| query.run(&cloud, &gripper, &pose.scene_from_object));
            let said: Vec<_> = said.map(|report| report.expect("a finite pose")).collect();
            answers.ask.push(start.elapsed().as_secs_f64());
            for (report, pose) in said.iter().zip(&poses) {
                let (verdict, collides) = (report.verdict, pose.in_collision);
                let came = if collides { 1.0 } else { 0.0 };
                answers.squared_errors += (report.collision_probability - came).powi(2);
                answers.asked += 1;
                answers.collisions_free += usize::from(collides && verdict == Verdict::Free);
                answers.free_in_collision +=
                    usize::from(!collides && verdict == Verdict::InCollision);
                answers.undecided += usize::from(verdict == Verdict::Undecided);
            }
        }
    }
    println!(
        "every, returns, prepare (ms), ten poses (ms), Brier score, collisions free, free in collision, undecided"
    );
    for (every, answers) in (1..).zip(thinned) {
        println!(
            "{every}, {}, {:.1}, {:.1}, {:.4}, {}, {}, {} of {}",
            answers.returns / SCENES as usize,
            1e3 * median(answers.prepare),
            1e3 * median(answers.ask),
            answers.squared_errors / answers.asked as f64,
            answers.collisions_free,
            answers.free_in_collision,
            answers.undecided,
            answers.asked,
        );
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
