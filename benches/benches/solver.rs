//! Leaf problems: the linear certificate, and the kernel problem by size, kernel width and noise.
#![allow(missing_docs, reason = "criterion_group! makes a public function without documentation")]

use std::hint::black_box;
use std::time::Duration;

use cloudtouch_benches::leaf::bowl_over_floor;
use cloudtouch_svm::{
    Class, DEFAULT_KAPPA_MAX, Kernel, Problem, Sample, Settings, Solver, Status, separate,
};
use criterion::{Criterion, criterion_group, criterion_main};

const SEED: u64 = 1;
/// Distance of the surfaces in a kernel problem: a plane does not settle it, box sides.
const GAP: f64 = 0.05;

fn certificate(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("certificate");
    group.sample_size(20).measurement_time(Duration::from_secs(1));
    for per_side in [20, 40, 100] {
        for (name, gap, std, reaches) in [("clear", 0.3, 0.01, true), ("close", 0.1, 0.02, false)] {
            let (a, b) = bowl_over_floor(per_side, gap, std, SEED);
            let run = || separate(black_box(&a), black_box(&b), DEFAULT_KAPPA_MAX);
            let reached = run().is_ok_and(|plane| plane.kappa >= DEFAULT_KAPPA_MAX);
            assert_eq!(reached, reaches, "{name} at 2x{per_side}");
            group.bench_function(format!("{name}/2x{per_side}"), |bencher| bencher.iter(run));
        }
    }
}

fn kernel(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("kernel");
    group.sample_size(10).measurement_time(Duration::from_secs(2));
    let mut solver = Solver::new(Settings::default()).expect("valid settings");
    let by_size = [20, 40, 100].map(|per_side| (per_side, 10.0, 0.02));
    let by_width = [2.0, 5.0, 20.0].map(|gamma| (40, gamma, 0.02));
    let by_noise = [0.0, 0.005, 0.05].map(|std| (40, 10.0, std));
    for (per_side, gamma, std) in by_size.into_iter().chain(by_width).chain(by_noise) {
        let samples = samples(per_side, std);
        let kernel = Kernel::Gaussian { gamma };
        let mut solve = || Problem::new(black_box(&samples), kernel).map(|p| solver.solve(&p));
        let solution = solve().expect("a valid problem");
        assert_eq!(solution.status, Status::Converged, "gamma {gamma}, std {std}, 2x{per_side}");
        // The rung is in the id: a change of rung is a change of what is measured.
        let rung = format!("{:?}", solution.rung).to_lowercase();
        let id = format!("2x{per_side}/gamma_{gamma}/std_{std}/{rung}");
        group.bench_function(id, |bencher| bencher.iter(&mut solve));
    }
}

fn samples(per_side: u64, std: f64) -> Vec<Sample> {
    let (a, b) = bowl_over_floor(per_side, GAP, std, SEED);
    let class = |points: Vec<_>, class| {
        let sample = move |point| Sample { point, class, radius: 1.0, penalty: 100.0 };
        points.into_iter().map(sample)
    };
    class(a, Class::A).chain(class(b, Class::B)).collect()
}

criterion_group!(benches, certificate, kernel);
criterion_main!(benches);
