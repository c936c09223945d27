//! The room in more and more points: queries, building, memory.

use std::fs;

use anyhow::{Context, Result};
use cloudtouch::{
    Mode,
    bvh::{Primitive, Tree, TreeSettings},
    noise::SensorModel,
};
use cloudtouch_geom::{PointCloud, UncertainPoint};

use super::{
    fresh::prepare,
    peers::ExactMeshes,
    scene::{POINTS, STD, Scene},
    timing::{least_of, ratio, three_digits, time},
    turns::{Timed, take_turns},
};
use crate::{
    answers::Pair,
    methods::{Draw, Ours},
    page::Section,
    statistics::median,
    table::Table,
    targets::{Findings, Target},
};

/// Points of the room.
const SIZES: [usize; 4] = [10_000, 100_000, 300_000, 1_000_000];
/// Poses asked of each, at most.
const POSES: usize = 30;
/// How often something is built; the least time counts.
const BUILDS: usize = 3;

/// What was measured of a room of one size.
struct Grown {
    points: usize,
    /// Ours, exact meshes.
    timed: Vec<Timed>,
    /// Points a second of the tree alone, and of the whole preparation.
    rates: [f64; 2],
    /// Bytes that a prepared cloud holds for each point.
    held: f64,
}

/// Measures every size.
pub(super) fn measure(scene: &Scene) -> Findings {
    let grown: Vec<Grown> =
        SIZES.into_iter().map(|points| Grown::measure(scene, points)).collect::<Result<_>>()?;
    let mut table = Table::new([
        "points",
        "query, median",
        "parry3d, exact meshes",
        "tree, M points/s",
        "prepare, M points/s",
        "bytes a point",
    ]);
    let million = |rate: f64| three_digits(1e-6 * rate);
    for g in &grown {
        let [tree, prepare] = g.rates.map(million);
        let held = format!("{:.0}", g.held);
        table.row([
            g.points.to_string(),
            time(g.median(0)),
            time(g.median(1)),
            tree,
            prepare,
            held,
        ]);
    }
    let section = Section::new("Larger scenes")
        .text(format_args!(
            "The room in more and more points, the piano in {POINTS}, {} mm of noise, {POSES} poses, \
             asked as above of clouds that are not refined. *Tree* is `Tree::build` alone, *prepare* \
             all of `Cloud::prepare`; of {BUILDS} the fastest. Meshes have as many triangles as the \
             cloud has points. *Bytes a point*: how much the resident memory of the process (`VmRSS`) \
             grows while a cloud is prepared; only the largest sizes mean something.",
            1e3 * STD
        ))
        .text(table);
    Ok((section, targets(&grown)))
}

impl Grown {
    fn measure(scene: &Scene, points: usize) -> Result<Self> {
        let (room, piano) = (scene.room(points, STD), scene.piano(STD));
        let before = resident()?;
        let kept = prepare(&room.cloud, STD)?;
        let held = (resident()? - before) / kept.len() as f64;
        drop(kept);
        let (_, preparing) = least_of(BUILDS, || prepare(&room.cloud, STD))?;
        let building = tree_time(&room.cloud)?;
        let rates = [building, preparing].map(|seconds| points as f64 / seconds);
        let draw = Draw { family: "", a: &room, b: &piano, mesh: &scene.piano };
        let ours = Ours::new("ours, not refined", Mode::Calibrated)?;
        let meshes = ExactMeshes(scene.meshes(points));
        let poses = &scene.poses[..scene.poses.len().min(POSES)];
        let timed = take_turns(&[&ours, &meshes], &draw, Pair::CloudCloud, poses)?;
        eprintln!("bench-report: {points} points done");
        Ok(Self { points, timed, rates, held })
    }

    /// Of the method with this number, s.
    fn median(&self, method: usize) -> f64 {
        median(&self.timed[method].seconds(None))
    }
}

/// Least time of the tree alone, s.
fn tree_time(cloud: &PointCloud) -> Result<f64> {
    let covariances = SensorModel::Isotropic { std: STD }.covariances(cloud)?;
    let points = cloud.points.iter().zip(covariances.iter());
    let point = |(&mean, &covariance)| Primitive::point(UncertainPoint { mean, covariance });
    let primitives: Vec<Primitive> = points.map(point).collect();
    let mut copies = vec![primitives; BUILDS];
    let build = || Ok(Tree::build(copies.pop().unwrap_or_default(), &TreeSettings::default())?);
    Ok(least_of(BUILDS, build)?.1)
}

/// Resident memory of this process, bytes; NaN where the kernel does not say.
fn resident() -> Result<f64> {
    let Ok(status) = fs::read_to_string("/proc/self/status") else { return Ok(f64::NAN) };
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kilobytes = line.and_then(|line| line.trim().strip_suffix(" kB"));
    Ok(1024.0 * kilobytes.context("VmRSS in /proc/self/status")?.parse::<f64>()?)
}

fn targets(grown: &[Grown]) -> Vec<Target> {
    let [Some(smallest), Some(largest)] = [grown.first(), grown.last()] else { return Vec::new() };
    let slowest = |i: usize| grown.iter().map(|g| g.rates[i]).fold(f64::INFINITY, f64::min);
    let rate = |points: f64| format!("{} M points/s", three_digits(1e-6 * points));
    let bytes = |b: f64| format!("{b:.0} bytes");
    let growth = largest.median(0) / smallest.median(0);
    let to = format!("room of 10k to {} points", largest.points);
    let least = |what: &str, value| Target::at_least(format!("{to}: {what}"), value, 2e6, rate);
    vec![
        Target::at_most(format!("{to}: query, median ≤ 2 × that at 10k"), growth, 2.0, ratio),
        least("tree ≥ 2 M points/s", slowest(0)),
        least("`Cloud::prepare` ≥ 2 M points/s", slowest(1)),
        Target::at_most(
            format!("{} points: a prepared cloud holds ≤ 200 bytes a point", largest.points),
            largest.held,
            200.0,
            bytes,
        ),
    ]
}
