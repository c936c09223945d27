//! How many instructions the kernels of a query take, by valgrind: unlike times these hardly depend on
//! the machine or on what else it does. `cargo run -p cloudtouch-benches --example instructions` compares
//! them with `benches/instructions.csv` and fails where one grew by more than a fifth; with `--update` it
//! writes the file. Counts are of the profile it is built with; the file has those of the dev profile, by
//! which tests are built.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::path::Path;
use std::process::{Command, ExitCode};

use cloudtouch::{Body, Cloud, CloudSettings, Detail, Judge, Mesh, Query, QuerySettings};
use cloudtouch_benches::leaf::bowl_over_floor;
use cloudtouch_benches::piano_room::{NOISE, classes, piano, prepared, room};
use cloudtouch_benches::sphere::sphere;
use cloudtouch_bvh::{Sought, SurfaceFlow, Tree, TreeSettings, visit_surfaces};
use cloudtouch_geom::{Pose, Vector3};
use cloudtouch_noise::{Neighborhoods, NoiseModel, NoiseSettings, Scratch, SensorModel};
use cloudtouch_svm::{Class, Kernel, Problem, Sample, Settings, Solver};
use cloudtouch_testkit::scene;

/// Points of a body where nothing else is said.
const POINTS: usize = 3000;
/// A count may grow by this share before the check fails.
const GROWTH: f64 = 0.2;

/// Runs a kernel, and says how many of its units that were.
type Run = fn() -> u64;

/// What is counted.
const KERNELS: [(&str, Run); 7] = [
    ("box pair", box_pairs),
    ("query near contact by geometry alone", || query(1, &piano_cloud().into())),
    ("query in deep overlap by geometry alone", || query(2, &piano_cloud().into())),
    ("query near contact with a mesh by geometry alone", || query(1, &piano_mesh().into())),
    ("refined point", refined_points),
    ("leaf problem of 2 x 20 points", leaf_problems),
    ("point of a tree built", tree_points),
];

fn main() -> ExitCode {
    let argument = std::env::args().nth(1);
    if let Some((_, run)) = KERNELS.iter().find(|(name, _)| argument.as_deref() == Some(name)) {
        println!("{}", run());
        return ExitCode::SUCCESS;
    }
    if !has_vectors() {
        println!("skipped: the recorded counts are of x86-64 processors with AVX2 and FMA");
        return ExitCode::SUCCESS;
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("skipped: valgrind is not installed");
        return ExitCode::SUCCESS;
    }
    let table = Path::new(env!("CARGO_MANIFEST_DIR")).join("instructions.csv");
    let counts = KERNELS.map(|(name, _)| (name, count(name)));
    if argument.as_deref() == Some("--update") {
        let rows = counts.map(|(name, count)| format!("{name},{count}\n")).concat();
        std::fs::write(table, format!("kernel,instructions\n{rows}")).expect("a writable table");
        return ExitCode::SUCCESS;
    }
    let text = std::fs::read_to_string(table).expect("the table of an earlier run");
    let recorded: BTreeMap<&str, u64> = (text.lines().skip(1))
        .filter_map(|line| line.split_once(','))
        .filter_map(|(name, count)| Some((name, count.parse().ok()?)))
        .collect();
    let mut code = ExitCode::SUCCESS;
    for (name, count) in counts {
        let before = recorded.get(name).copied().unwrap_or(0);
        let grew = count as f64 > (1.0 + GROWTH) * before as f64;
        println!("{name}: {count}, recorded {before}{}", if grew { ": GREW" } else { "" });
        if grew {
            code = ExitCode::FAILURE;
        }
    }
    code
}

/// Kernels that choose their instructions by the processor take as many as recorded.
#[cfg(target_arch = "x86_64")]
fn has_vectors() -> bool {
    std::is_x86_feature_detected!("avx2") && std::is_x86_feature_detected!("fma")
}

#[cfg(not(target_arch = "x86_64"))]
fn has_vectors() -> bool {
    false
}

/// Instructions of a kernel for each of its units.
fn count(name: &str) -> u64 {
    let program = std::env::current_exe().expect("this program");
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"])
        .arg("--toggle-collect=instructions::measured")
        .arg(program)
        .arg(name)
        .env("RAYON_NUM_THREADS", "1")
        .output()
        .expect("valgrind starts");
    let said = String::from_utf8_lossy(&output.stderr);
    let collected = said.lines().find_map(|line| line.split_once("Collected : "));
    let total: u64 = collected.and_then(|(_, n)| n.trim().parse().ok()).expect("a count");
    let units: u64 = String::from_utf8_lossy(&output.stdout).trim().parse().expect("units");
    assert!(total > 0 && units > 0, "nothing was counted: {said}");
    total / units
}

/// Only what runs in here is counted.
#[inline(never)]
fn measured(kernel: &mut dyn FnMut() -> u64) -> u64 {
    black_box(kernel())
}

fn box_pairs() -> u64 {
    let settings = TreeSettings::default();
    let [a, b] = [1, 2].map(|stream| {
        Tree::build(sphere(stream, POINTS as u64, NOISE), &settings).expect("a tree")
    });
    let pose = Pose::from_translation(Vector3::new(1.02, 0.0, 0.0));
    let sought = Sought { within: 6.0, margin: 0.0, crossings: true, drift: None };
    measured(&mut || {
        let outcome = visit_surfaces((&a, &b), &pose, sought, |_| SurfaceFlow::Within(6.0));
        outcome.expect("a finite pose").nodes_visited as u64
    })
}

fn piano_cloud() -> Cloud {
    prepared(&piano(POINTS)).refined().expect("ordinary noise")
}

/// Of some ten thousand triangles.
fn piano_mesh() -> Mesh {
    let fine = scene::subdivide_to_max_edge(&scene::piano(), 0.13);
    Mesh::prepare(&fine).expect("a good mesh")
}

fn query(class: usize, piano: &Body) -> u64 {
    let room = prepared(&room(POINTS)).refined().expect("ordinary noise");
    let judge = Judge::default().without_classifier();
    let settings = QuerySettings { judge, detail: Detail::Probability, ..Default::default() };
    let query = Query::new(settings).expect("good settings");
    let pose = classes()[class].pose.scene_from_object;
    let run = || query.run(&room, piano, &pose).expect("a finite pose");
    // What a first query computes once is no part of it.
    run();
    measured(&mut || {
        black_box(run());
        1
    })
}

fn refined_points() -> u64 {
    let cloud = room(POINTS);
    let near = Neighborhoods::new(cloud.points.clone()).expect("finite points");
    let sensor = SensorModel::Isotropic { std: NOISE }.covariances(&cloud).expect("a sensor");
    let model = NoiseModel::new(NoiseSettings::default()).expect("settings");
    let mut scratch = Scratch::default();
    measured(&mut || {
        let some = (0..POINTS).step_by(10);
        for index in some.clone() {
            black_box(model.refine(index, &near, &sensor, f64::INFINITY, &mut scratch));
        }
        some.count() as u64
    })
}

fn leaf_problems() -> u64 {
    /// Distance of the surfaces, box sides: SMO solves some of these, the interior point method others.
    const GAPS: [f64; 6] = [-0.05, -0.02, 0.0, 0.02, 0.05, 0.1];
    let problems = GAPS.map(|gap| {
        let (a, b) = bowl_over_floor(20, gap, 0.03, 1);
        let sample = |point, class| Sample { point, class, radius: 1.0, penalty: 100.0 };
        let a = a.into_iter().map(|point| sample(point, Class::A));
        let samples: Vec<Sample> =
            a.chain(b.into_iter().map(|point| sample(point, Class::B))).collect();
        Problem::new(&samples, Kernel::Gaussian { gamma: 10.0 }).expect("a valid problem")
    });
    let mut solver = Solver::new(Settings::default()).expect("valid settings");
    measured(&mut || {
        for problem in &problems {
            black_box(solver.solve(problem));
        }
        GAPS.len() as u64
    })
}

fn tree_points() -> u64 {
    let points = sphere(1, POINTS as u64, NOISE);
    let settings = CloudSettings::new(SensorModel::Isotropic { std: NOISE }).tree;
    measured(&mut || {
        let tree = Tree::build(points.clone(), &settings).expect("a tree");
        black_box(tree).len() as u64
    })
}
