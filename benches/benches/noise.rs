//! What preparing a cloud costs: neighbour index, sensor model, and the refinement of points.
#![allow(missing_docs, reason = "criterion_group! makes a public function without documentation")]

use std::hint::black_box;
use std::time::Duration;

use cloudtouch_benches::piano_room::{NOISE, room};
use cloudtouch_noise::{
    Combination, Neighborhoods, NoiseModel, NoiseSettings, Scratch, SensorModel,
};
use criterion::{BatchSize, BenchmarkId, Criterion, criterion_group, criterion_main};

/// Points refined in one measurement, spread over the cloud.
const REFINED: usize = 1000;

fn noise(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("noise");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    for count in [10_000, 100_000] {
        let cloud = room(count);
        let neighborhoods = Neighborhoods::new(cloud.points.clone()).expect("finite points");
        assert_eq!(neighborhoods.distinct(), count);
        group.bench_function(BenchmarkId::new("neighborhoods", count), |bencher| {
            bencher.iter_batched(
                || cloud.points.clone(),
                Neighborhoods::new,
                BatchSize::LargeInput,
            );
        });
        let sensor = SensorModel::Lidar { range_std: NOISE, beam_rad: 0.001 };
        group.bench_function(BenchmarkId::new("lidar_covariances", count), |bencher| {
            bencher.iter(|| sensor.covariances(black_box(&cloud)));
        });
        let sensor = SensorModel::Isotropic { std: NOISE };
        let covariances = sensor.covariances(&cloud).expect("a sensor");
        for combination in
            [Combination::Precision, Combination::Convolution, Combination::SurfacePosterior]
        {
            let settings = NoiseSettings { combination, ..NoiseSettings::default() };
            let model = NoiseModel::new(settings).expect("settings");
            let mut scratch = Scratch::default();
            let mut refine = |index: usize| {
                model.refine(index, &neighborhoods, &covariances, f64::INFINITY, &mut scratch)
            };
            let step = count / REFINED;
            assert!((0..count).step_by(step).all(|i| refine(i).point.covariance.is_finite()));
            let name = format!("refine_1000_{combination:?}").to_lowercase();
            group.bench_function(BenchmarkId::new(name, count), |bencher| {
                bencher.iter(|| {
                    for index in (0..count).step_by(step) {
                        black_box(refine(index));
                    }
                });
            });
        }
    }
}

criterion_group!(benches, noise);
criterion_main!(benches);
