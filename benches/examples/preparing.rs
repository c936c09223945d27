//! How long it takes to prepare a cloud and to refine its points: clouds whose noise is far below
//! their spacing, and dense ones whose noise is several spacings.

use std::hint::black_box;
use std::time::Instant;

use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings};
use cloudtouch_benches::piano_room::{NOISE, room};
use cloudtouch_geom::{PointCloud, Pose};
use cloudtouch_noise::{
    Combination, Neighborhoods, NoiseModel, NoiseSettings, Representatives, SensorNoise,
    spacings_at,
};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::{scene, surface};

/// Each time is the least of so many.
const RUNS: usize = 5;

fn main() {
    let large = std::env::args().any(|argument| argument == "large");
    println!(
        "cloud, points, prepare (M points/s), prepare and refine (ms), noise model (µs/point), of points"
    );
    measure("room, 2 mm", &room(10_000), NOISE);
    for noise in [0.01, 0.02] {
        measure(&format!("3 mm spacing, {} mm", noise * 1e3), &dense(noise), noise);
    }
    if large {
        measure("room, 2 mm", &room(1_000_000), NOISE);
    }
}

/// A box of 12 × 15 × 20 cm with 10,000 samples, some 3 mm apart.
fn dense(noise: f64) -> PointCloud {
    let mesh = scene::moved(&scene::cuboid([0.12, 0.15, 0.2]), &Pose::identity());
    let points = surface::positions(&surface::sample_surface(&mesh, 10_000, 3));
    PointCloud::from_points(add_noise(&points, NoiseKind::Gaussian, noise, 3))
}

fn measure(name: &str, cloud: &PointCloud, std: f64) {
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    let prepare = || Cloud::prepare(cloud, &settings).expect("a usable cloud");
    let runs = if cloud.len() > 100_000 { 2 } else { RUNS };
    let preparing = least(runs, prepare);
    let refining = least(runs, || prepare().refined().expect("in range"));
    let near = Neighborhoods::new(cloud.points.clone()).expect("finite points");
    let sensor = SensorModel::Isotropic { std }.covariances(cloud).expect("a sensor");
    let (modelling, pieces) = model(&near, &sensor, runs);
    println!(
        "{name}, {}, {:.2}, {:.1}, {:.2}, {pieces}",
        cloud.len(),
        cloud.len() as f64 / preparing / 1e6,
        refining * 1e3,
        modelling / pieces as f64 * 1e6,
    );
}

/// Seconds to refine the points that stand for a cloud, and how many these are.
fn model(near: &Neighborhoods, sensor: &SensorNoise, runs: usize) -> (f64, usize) {
    let settings =
        NoiseSettings { combination: Combination::SurfacePosterior, ..NoiseSettings::default() };
    let model = NoiseModel::new(settings).expect("settings");
    let mut scratch = cloudtouch_noise::Scratch::default();
    let sample: Vec<usize> = (0..near.points().len()).step_by(near.points().len() / 200).collect();
    let spacings = spacings_at(near, sample.iter().copied());
    match Representatives::choose(near, sensor, (&sample, &spacings)).expect("an index") {
        None => {
            let all = least(runs, || model.refine_all(near, sensor, f64::INFINITY));
            (all, near.points().len())
        }
        Some(chosen) => {
            let all = least(runs, || {
                for &index in chosen.indices() {
                    let index = index as usize;
                    black_box(model.refine_representative(
                        index,
                        near,
                        &chosen,
                        sensor,
                        f64::INFINITY,
                        &mut scratch,
                    ));
                }
            });
            (all, chosen.indices().len())
        }
    }
}

fn least<T>(runs: usize, mut run: impl FnMut() -> T) -> f64 {
    let times = (0..runs).map(|_| {
        let start = Instant::now();
        black_box(run());
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}
