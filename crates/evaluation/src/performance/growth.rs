//! The room in more and more points: queries, building, memory.

use std::alloc::System;

use anyhow::Result;
use cloudtouch_testkit::family::Observation;
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

use super::scene::{POINTS, STD, Scene};
use super::timing::{least_of, ratio, three_digits, time};
use super::turns::take_turns;
use crate::answers::Pair;
use crate::methods::{Draw, ExactMeshes, Ours, prepared};
use crate::report::{Findings, Section, Table, Target};
use crate::statistics::median;

/// Counts what is held, which the resident memory does not tell: a part of it was used before.
#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Points of the room.
const SIZES: [usize; 4] = [10_000, 100_000, 300_000, 1_000_000];
/// Poses asked of each, at most.
const POSES: usize = 30;
/// How often something is built; the least time counts.
const BUILDS: usize = 3;

/// Measures every size.
pub(super) fn measure(scene: &Scene) -> Findings {
    let header = ["points", "query, median", "parry3d, exact meshes", "prepare, M points/s"];
    let mut table = Table::new(header.into_iter().chain(["bytes a point", "refined"]));
    let million = |rate: f64| three_digits(1e-6 * rate);
    let (mut rows, mut held) = (Vec::new(), [f64::NAN; 2]);
    for points in SIZES {
        let (room, piano) = (scene.room(points, STD), scene.piano(STD));
        held = bytes_a_point(&room)?;
        let (_, seconds) = least_of(BUILDS, || prepared(&room))?;
        let rate = points as f64 / seconds;
        let draw = Draw { family: "", a: &room, b: &piano, mesh: &scene.piano };
        let ours = Ours::new("ours, not refined")?;
        let meshes = ExactMeshes(scene.meshes(points));
        let poses = &scene.poses[..scene.poses.len().min(POSES)];
        let timed = take_turns(&[&ours, &meshes], &draw, Pair::CloudCloud, poses)?;
        let [ours, meshes] = [0, 1].map(|i| median(&timed[i].seconds(None)));
        rows.push([ours, meshes, rate]);
        let row = [points.to_string(), time(ours), time(meshes), million(rate)];
        table.row(row.into_iter().chain(held.map(|held| format!("{held:.0}"))));
    }
    let section = Section::new("Larger scenes").text(format_args!(
        "The room in more and more points, the piano in {POINTS}, {} mm of noise, {POSES} poses, asked as above of \
         clouds that are not refined. *Prepare*: `Cloud::prepare`, the fastest of {BUILDS}. Meshes have as many \
         triangles as the cloud has points. *Bytes a point*: what it holds, prepared and refined, by its allocator.",
        1e3 * STD
    ));
    let (first, [ours, meshes, ..]) = (rows[0], rows[SIZES.len() - 1]);
    let least = rows.iter().map(|row| row[2]).fold(f64::INFINITY, f64::min);
    let [at, to] = ["", "10k to "].map(|from| format!("room of {from}{} points", SIZES[3]));
    let rate = |rate: f64| format!("{} M points/s", million(rate));
    let bytes = |held: f64| format!("{held:.0} bytes");
    let (by_meshes, growth) = (ours / meshes, ours / first[0]);
    let meshes = format!("{at}: query, median ≤ 0.2 × parry3d on exact meshes");
    let small = "room of 10000 points: `Cloud::prepare` ≥ 4 M points/s";
    let targets = vec![
        Target::new(meshes, ratio(by_meshes), by_meshes <= 0.2),
        Target::new(format!("{at}: query, median ≤ 2 × that at 10k"), ratio(growth), growth <= 2.0),
        Target::new(format!("{to}: `Cloud::prepare` ≥ 2 M points/s"), rate(least), least >= 2e6),
        Target::new(small, rate(first[2]), first[2] >= 4e6),
        Target::new(format!("{at}: ≤ 120 bytes a point"), bytes(held[0]), held[0] <= 120.0),
        Target::new(format!("{at}: refined ≤ 200 bytes a point"), bytes(held[1]), held[1] <= 200.0),
    ];
    Ok((section.text(table), targets))
}

/// What a cloud of the room holds a point, bytes: prepared and refined.
fn bytes_a_point(room: &Observation) -> Result<[f64; 2]> {
    let before = Region::new(ALLOCATOR);
    let cloud = prepared(room)?;
    let count = cloud.len() as f64;
    let held = || {
        let change = before.change();
        (change.bytes_allocated as f64 - change.bytes_deallocated as f64) / count
    };
    let first = held();
    let _cloud = cloud.refined()?;
    Ok([first, held()])
}
