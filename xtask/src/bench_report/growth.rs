//! The room in more and more points: queries, building, memory.

use std::fmt::Write as _;

use anyhow::Result;
use cloudtouch::{
    bvh::{Primitive, Tree, TreeSettings},
    noise::SensorModel,
};
use cloudtouch_geom::{PointCloud, Pose, UncertainPoint};

use super::{
    Run, Section,
    memory::{self, Memory},
    method::{self, DISTANCE, LAZY, MESHES},
    plots,
    poses::Posed,
    room::{Asked, ask_in_turn, errors},
    scene::{POINTS, STD, prepare},
    target::Target,
    timing::{median, p95, ratio, three_digits, time, timed},
};
use crate::common::{statistics::auc, table::Table};

/// How often something is built; the least counts.
const BUILDS: usize = 3;
/// Ours on the smallest room, asked in turn with the rest.
const SMALLEST: &str = "ours, 10k";
/// What a cloud may take whatever its size, bytes.
const BASE: f64 = 20e6;

/// What was measured of a room of one size.
pub(super) struct Grown {
    pub(super) points: usize,
    pub(super) asked: Vec<Asked>,
    /// Of ours on the poses asked.
    auc: f64,
    /// Least time of the tree alone, s.
    tree: f64,
    /// Least time of the whole preparation, s.
    prepare: f64,
    memory: Option<Memory>,
}

impl Grown {
    /// Times of a method, s.
    pub(super) fn of(&self, name: &str) -> &[f64] {
        self.asked.iter().find(|a| a.name == name).map_or(&[], |a| &a.seconds)
    }

    /// Median query time over that of the smallest room in the same minutes.
    fn growth(&self) -> f64 {
        median(self.of(LAZY)) / median(self.of(SMALLEST))
    }

    /// Bytes a point beyond what any cloud may take.
    fn bytes_a_point(&self) -> f64 {
        self.memory.map_or(f64::NAN, |m| (m.held - BASE).max(0.0) / self.points as f64)
    }
}

/// What is said before the tables.
const INTRODUCTION: &str = "The room in more and more points, the piano in 10,000, 2 mm of noise. \
*Query* is a prepared one, over the same poses, as above; *to 10k* compares its median with that of \
the room of 10,000 points, asked in turn in the same minutes; of the smallest room itself it shows \
how far times of equal work differ. *Tree* is `Tree::build` alone, \
*prepare* all of `Cloud::prepare`; of three the fastest. Meshes have as many triangles as the cloud \
has points.";

/// Measures every size.
pub(super) fn measure(run: &Run<'_>) -> Result<Section> {
    let count = run.scene.poses.len().min(run.plan.growth_poses);
    let poses = &run.scene.poses[..count];
    let mut grown = Vec::new();
    for &points in run.plan.sizes {
        grown.push(of_size(run, points, poses)?);
        eprintln!("bench-report: {points} points done");
    }
    plots::growth(&run.figures.join("performance-growth.svg"), &grown)?;
    let mut text = format!("{INTRODUCTION} {count} poses.\n\n{}\n", table(&grown));
    write!(
        text,
        "![Times of queries by points of the scene](figures/performance-growth.svg)\n\nBars reach \
         from the 5th to the 95th percentile over poses.\n\nMemory: a fresh process reads the points, \
         notes its resident memory (`VmRSS`), prepares the room and asks about the poses, and notes \
         it again; the difference is *held*. *Peak* is the same with the most that was ever resident \
         (`VmHWM`). What the allocator keeps for later counts. Leaves that no pose has come near are \
         not computed.\n"
    )?;
    if let Some(largest) = grown.last() {
        write!(
            text,
            "\nErrors on these poses, {} points:\n\n{}",
            short(largest.points),
            errors(&largest.asked, poses)
        )?;
    }
    Ok(Section { title: "Larger scenes", text, targets: targets(&grown) })
}

fn of_size(run: &Run<'_>, points: usize, poses: &[Posed]) -> Result<Grown> {
    let (room, small) = (run.scene.room(points, STD), run.scene.room(POINTS, STD));
    let piano = run.scene.piano(STD);
    let prepared = least(|| prepare(&room, STD).map(drop))?;
    let tree = tree_time(&room)?;
    let placed: Vec<Pose> = poses.iter().map(|p| p.pose.scene_from_object).collect();
    let memory = if memory::is_possible() {
        Some(memory::measure(&run.figures, [&room, &piano], &placed)?)
    } else {
        None
    };
    let methods = [
        method::lazy([&room, &piano], STD)?,
        method::Method { name: SMALLEST, ..method::lazy([&small, &piano], STD)? },
        method::meshes([&run.scene.room_mesh(points), &run.scene.piano_mesh()])?,
        method::distance([&room, &piano])?,
    ];
    let asked = ask_in_turn(&methods, poses, run.plan.repeats)?;
    let ours = asked.iter().find(|a| a.name == LAZY);
    let auc = ours.map_or(f64::NAN, |a| auc(&a.scored(poses, None)));
    Ok(Grown { points, asked, auc, tree, prepare: prepared, memory })
}

fn least(mut build: impl FnMut() -> Result<()>) -> Result<f64> {
    let mut least = f64::INFINITY;
    for _ in 0..BUILDS {
        let (built, seconds) = timed(&mut build);
        built?;
        least = least.min(seconds);
    }
    Ok(least)
}

fn tree_time(cloud: &PointCloud) -> Result<f64> {
    let covariances = SensorModel::Isotropic { std: STD }.covariances(cloud)?;
    let points = cloud.points.iter().zip(covariances.iter());
    let point = |(&mean, &covariance)| Primitive::point(UncertainPoint { mean, covariance });
    let primitives: Vec<Primitive> = points.map(point).collect();
    let mut least = f64::INFINITY;
    for _ in 0..BUILDS {
        let points = primitives.clone();
        let (tree, seconds) = timed(|| Tree::build(points, &TreeSettings::default()));
        tree?;
        least = least.min(seconds);
    }
    Ok(least)
}

fn table(grown: &[Grown]) -> Table {
    let mut table = Table::new(&[
        "points",
        "query, median",
        "p95",
        "to 10k",
        "AUC",
        "kiddo, median",
        "parry3d, median",
        "tree, points/s",
        "prepare, points/s",
        "held",
        "held, bytes a point",
        "peak",
    ]);
    let megabytes = |bytes: f64| format!("{} MB", three_digits(bytes / 1e6));
    let rate =
        |points: usize, seconds: f64| format!("{} M", three_digits(points as f64 / seconds / 1e6));
    for g in grown {
        let memory = |of: fn(&Memory) -> f64| g.memory.as_ref().map(of);
        let held = memory(|m| m.held);
        table.row([
            short(g.points),
            time(median(g.of(LAZY))),
            time(p95(g.of(LAZY))),
            ratio(g.growth()),
            format!("{:.3}", g.auc),
            time(median(g.of(DISTANCE))),
            time(median(g.of(MESHES))),
            rate(g.points, g.tree),
            rate(g.points, g.prepare),
            held.map_or("-".into(), megabytes),
            held.map_or("-".into(), |bytes| format!("{:.0}", bytes / g.points as f64)),
            memory(|m| m.peak).map_or("-".into(), megabytes),
        ]);
    }
    table
}

/// A number of points in thousands or millions.
fn short(points: usize) -> String {
    if points.is_multiple_of(1_000_000) {
        format!("{}M", points / 1_000_000)
    } else {
        format!("{}k", points / 1000)
    }
}

/// Each is judged by the size that does worst.
fn targets(grown: &[Grown]) -> Vec<Target> {
    let over = |of: &dyn Fn(&Grown) -> f64, worse: fn(f64, f64) -> f64| {
        grown.iter().map(of).reduce(worse).unwrap_or(f64::NAN)
    };
    let slowest =
        |seconds: &dyn Fn(&Grown) -> f64| over(&|g| g.points as f64 / seconds(g), f64::min);
    let rate = |points: f64| format!("{} M points/s", three_digits(points / 1e6));
    let largest = grown.last().map_or(0, |g| g.points);
    let to = format!("room of 10k to {} points", short(largest));
    let small = "memory: ≤ 200 bytes a point and 20 MB";
    let bytes = |b: f64| format!("{b:.0} bytes a point beyond 20 MB");
    vec![
        Target::at_most(
            format!("{to}: query, median ≤ 2 × that at 10k"),
            over(&Grown::growth, f64::max),
            2.0,
            ratio,
        ),
        Target::at_least(format!("{to}: tree ≥ 2 M points/s"), slowest(&|g| g.tree), 2e6, rate),
        Target::at_least(
            format!("{to}: `Cloud::prepare` ≥ 2 M points/s"),
            slowest(&|g| g.prepare),
            2e6,
            rate,
        ),
        if memory::is_possible() {
            let most = over(&Grown::bytes_a_point, f64::max);
            Target::at_most(format!("{to}: {small}"), most, 200.0, bytes)
        } else {
            Target::skipped(format!("{to}: {small}"), "there is no /proc here")
        },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grown(points: usize, tree: f64, held: f64) -> Grown {
        let memory = Some(Memory { held, peak: 2.0 * held });
        Grown { points, asked: Vec::new(), auc: 1.0, tree, prepare: 2.0 * tree, memory }
    }

    #[test]
    fn the_worst_size_decides() {
        // 4 M and 2.5 M points a second; 0 and 180 bytes a point beyond 20 MB.
        let both = [grown(10_000, 0.0025, 15e6), grown(1_000_000, 0.4, 200e6)];
        let text = super::super::target::table(&targets(&both)).to_string();
        let rows: Vec<&str> = text.lines().skip(2).collect();
        assert!(rows[0].contains("not measured"), "{text}");
        assert!(rows[1].contains("2.50 M points/s") && rows[1].contains("| yes"), "{text}");
        assert!(rows[2].contains("1.25 M points/s") && rows[2].contains("**no**"), "{text}");
        assert!(rows[3].contains("180 bytes a point") && rows[3].contains("| yes"), "{text}");
    }

    #[test]
    fn a_small_cloud_may_take_what_any_may() {
        assert_eq!(grown(10_000, 1.0, 15e6).bytes_a_point(), 0.0);
        assert!(grown(10_000, 1.0, 40e6).bytes_a_point() > 1999.0);
    }
}
