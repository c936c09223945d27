//! The room in more and more points: queries, building, memory.

use std::fs;

use anyhow::{Context, Result};
use cloudtouch::bvh::{Primitive, Tree, TreeSettings};
use cloudtouch::noise::SensorModel;
use cloudtouch_geom::{PointCloud, UncertainPoint};

use super::scene::{POINTS, STD, Scene};
use super::timing::{least_of, ratio, three_digits, time};
use super::turns::take_turns;
use crate::answers::Pair;
use crate::methods::{Draw, ExactMeshes, Ours, prepared};
use crate::report::{Findings, Section, Table, Target};
use crate::statistics::median;

/// Points of the room.
const SIZES: [usize; 4] = [10_000, 100_000, 300_000, 1_000_000];
/// Poses asked of each, at most.
const POSES: usize = 30;
/// How often something is built; the least time counts.
const BUILDS: usize = 3;

/// Measures every size.
pub(super) fn measure(scene: &Scene) -> Findings {
    let header = ["points", "query, median", "parry3d, exact meshes", "tree, M points/s"];
    let mut table = Table::new(header.into_iter().chain(["prepare, M points/s", "bytes a point"]));
    let million = |rate: f64| three_digits(1e-6 * rate);
    let (mut queries, mut slowest, mut held) = (Vec::new(), [f64::INFINITY; 2], f64::NAN);
    for points in SIZES {
        let (room, piano) = (scene.room(points, STD), scene.piano(STD));
        let before = resident()?;
        let kept = prepared(&room)?;
        held = (resident()? - before) / kept.len() as f64;
        drop(kept);
        let (_, preparing) = least_of(BUILDS, || prepared(&room))?;
        let rates = [tree_time(&room.cloud)?, preparing].map(|seconds| points as f64 / seconds);
        slowest = [0, 1].map(|k| slowest[k].min(rates[k]));
        let draw = Draw { family: "", a: &room, b: &piano, mesh: &scene.piano };
        let ours = Ours::new("ours, not refined")?;
        let meshes = ExactMeshes(scene.meshes(points));
        let poses = &scene.poses[..scene.poses.len().min(POSES)];
        let timed = take_turns(&[&ours, &meshes], &draw, Pair::CloudCloud, poses)?;
        let [ours, meshes] = [0, 1].map(|i| median(&timed[i].seconds(None)));
        queries.push(ours);
        let [tree, all] = rates.map(million);
        table.row([points.to_string(), time(ours), time(meshes), tree, all, format!("{held:.0}")]);
    }
    let section = Section::new("Larger scenes").text(format_args!(
        "The room in more and more points, the piano in {POINTS}, {} mm of noise, {POSES} poses, \
         asked as above of clouds that are not refined. *Tree* is `Tree::build` alone, *prepare* \
         all of `Cloud::prepare`; of {BUILDS} the fastest. Meshes have as many triangles as the \
         cloud has points. *Bytes a point*: how much the resident memory of the process (`VmRSS`) \
         grows while a cloud is prepared; only the largest sizes mean something.",
        1e3 * STD
    ));
    let largest = SIZES[SIZES.len() - 1];
    let to = format!("room of 10k to {largest} points");
    let rate = |rate: f64| format!("{} M points/s", million(rate));
    let growth = queries[queries.len() - 1] / queries[0];
    let [tree, all] = slowest;
    let bytes = format!("{largest} points: a prepared cloud holds ≤ 200 bytes a point");
    let targets = vec![
        Target::new(format!("{to}: query, median ≤ 2 × that at 10k"), ratio(growth), growth <= 2.0),
        Target::new(format!("{to}: tree ≥ 2 M points/s"), rate(tree), tree >= 2e6),
        Target::new(format!("{to}: `Cloud::prepare` ≥ 2 M points/s"), rate(all), all >= 2e6),
        Target::new(bytes, format!("{held:.0} bytes"), held <= 200.0),
    ];
    Ok((section.text(table), targets))
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
