//! The room in more and more points: queries, building, memory.

use anyhow::Result;
use cloudtouch::{
    bvh::{Primitive, Tree, TreeSettings},
    noise::SensorModel,
};
use cloudtouch_geom::{PointCloud, UncertainPoint};

use super::{
    asked::{Asked, ask_in_turn, errors, seconds},
    memory::{self, Memory},
    methods::{self, DISTANCE, LAZY, MESHES, prepare},
    scene::{POINTS, Posed, STD, Scene},
    target::{Findings, Target},
    timing::{curve, least_of, ratio, three_digits, time, times},
};
use crate::{
    figure::{Axis, Figure, Panel},
    page::Section,
    statistics::median,
    table::Table,
};

/// Points of the room.
const SIZES: [usize; 5] = [10_000, 30_000, 100_000, 300_000, 1_000_000];
/// Poses asked of each, at most.
const POSES: usize = 30;
/// How often something is built; the least time counts.
const BUILDS: usize = 3;
/// Ours on the smallest room, asked in turn with the rest.
const SMALLEST: &str = "ours, 10k";
/// What a cloud may take whatever its size, bytes.
const BASE: f64 = 20e6;

/// What was measured of a room of one size.
struct Grown {
    points: usize,
    asked: Vec<Asked>,
    /// Least time of the tree alone, s.
    tree: f64,
    /// Least time of the whole preparation, s.
    prepare: f64,
    memory: Option<Memory>,
}

const INTRODUCTION: &str = "The room in more and more points, the piano in 10,000, 2 mm of noise. \
*Query* is one of clouds that are prepared and not refined, over the same poses, as above; *to 10k* \
compares its median with that of the room of 10,000 points, asked in turn in the same minutes; of \
the smallest room itself it shows how far times of equal work differ. *Tree* is `Tree::build` alone, \
*prepare* all of `Cloud::prepare`; of three the fastest. Meshes have as many triangles as the cloud \
has points.";

const MEMORY: &str = "Bars reach from the 5th to the 95th percentile over poses.

Memory: a fresh process reads the points, notes its resident memory (`VmRSS`), prepares the room and \
asks about the poses, and notes it again; the difference is *held*. *Peak* is the same with the most \
that was ever resident (`VmHWM`). What the allocator keeps of small pieces for later counts. Leaves \
that no pose has come near are not computed.";

impl Grown {
    fn measure(scene: &Scene, points: usize, poses: &[Posed]) -> Result<Self> {
        let (room, small) = (scene.room(points, STD), scene.room(POINTS, STD));
        let piano = scene.piano(STD);
        let (_, prepare) = least_of(BUILDS, || prepare(&room, STD))?;
        let tree = tree_time(&room)?;
        let memory = memory::measure([&room, &piano], poses)?;
        let methods = [
            methods::lazy(LAZY, [&room, &piano], STD)?,
            methods::lazy(SMALLEST, [&small, &piano], STD)?,
            methods::meshes(&scene.meshes(points))?,
            methods::distance([&room, &piano])?,
        ];
        let asked = ask_in_turn(&methods, poses)?;
        eprintln!("bench-report: {points} points done");
        Ok(Self { points, asked, tree, prepare, memory })
    }

    /// Times of a method, s.
    fn of(&self, name: &str) -> Vec<f64> {
        seconds(&self.asked, name, None)
    }

    /// Median query time over that of the smallest room in the same minutes.
    fn growth(&self) -> f64 {
        median(&self.of(LAZY)) / median(&self.of(SMALLEST))
    }

    /// Bytes a point beyond what any cloud may take.
    fn bytes_a_point(&self) -> f64 {
        self.memory.map_or(f64::NAN, |m| (m.held - BASE).max(0.0) / self.points as f64)
    }
}

/// Measures every size.
pub(super) fn measure(scene: &Scene) -> Findings {
    let poses = &scene.poses[..scene.poses.len().min(POSES)];
    let each = SIZES.into_iter().map(|points| Grown::measure(scene, points, poses));
    let grown: Vec<Grown> = each.collect::<Result<_>>()?;
    let mut section = Section::new("Larger scenes")
        .text(format_args!("{INTRODUCTION} {} poses.", poses.len()))
        .text(table(&grown))
        .figure("performance-growth", "Times of queries by points of the scene", figure(&grown))
        .text(MEMORY);
    if let Some(largest) = grown.last() {
        section = section
            .text(format_args!("Errors on these poses, {} points:", short(largest.points)))
            .text(errors(&largest.asked));
    }
    Ok((section, targets(&grown)))
}

fn tree_time(cloud: &PointCloud) -> Result<f64> {
    let covariances = SensorModel::Isotropic { std: STD }.covariances(cloud)?;
    let points = cloud.points.iter().zip(&covariances);
    let point = |(&mean, &covariance)| Primitive::point(UncertainPoint { mean, covariance });
    let primitives: Vec<Primitive> = points.map(point).collect();
    let mut copies = vec![primitives; BUILDS];
    let build = || Ok(Tree::build(copies.pop().unwrap_or_default(), &TreeSettings::default())?);
    Ok(least_of(BUILDS, build)?.1)
}

fn table(grown: &[Grown]) -> Table {
    let mut table = Table::new([
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
    let rate = |points: usize, seconds: f64| millions(points as f64 / seconds);
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".into());
    let megabytes = |bytes: f64| format!("{} MB", three_digits(bytes / 1e6));
    for g in grown {
        let [median_time, p95] = times(&g.of(LAZY));
        let auc = g.asked.iter().find(|a| a.name == LAZY).map(|a| format!("{:.3}", a.auc(None)));
        let a_point = |m: Memory| format!("{:.0}", m.held / g.points as f64);
        table.row([
            short(g.points),
            median_time,
            p95,
            ratio(g.growth()),
            or_dash(auc),
            time(median(&g.of(DISTANCE))),
            time(median(&g.of(MESHES))),
            rate(g.points, g.tree),
            rate(g.points, g.prepare),
            or_dash(g.memory.map(|m| megabytes(m.held))),
            or_dash(g.memory.map(a_point)),
            or_dash(g.memory.map(|m| megabytes(m.peak))),
        ]);
    }
    table
}

fn millions(points: f64) -> String {
    format!("{} M", three_digits(points / 1e6))
}

/// A number of points in thousands or millions.
fn short(points: usize) -> String {
    let millions = points.is_multiple_of(1_000_000);
    if millions { format!("{}M", points / 1_000_000) } else { format!("{}k", points / 1000) }
}

/// Time of a query over the points of the scene.
fn figure(grown: &[Grown]) -> Figure {
    let panel = Panel::new(Axis::log("points of the scene"), Axis::log("time (ms)"));
    let of = |name: &str| -> Vec<_> { grown.iter().map(|g| (g.points, g.of(name))).collect() };
    let curves = [LAZY, DISTANCE, MESHES].map(|name| curve(name, &of(name)));
    let panel = curves.into_iter().flatten().fold(panel, Panel::series);
    Figure::new("Prepared queries against 10,000 points").panel(panel)
}

/// Each is judged by the size that does worst.
fn targets(grown: &[Grown]) -> Vec<Target> {
    let over = |of: &dyn Fn(&Grown) -> f64, worse: fn(f64, f64) -> f64| {
        grown.iter().map(of).reduce(worse).unwrap_or(f64::NAN)
    };
    let slowest =
        |seconds: &dyn Fn(&Grown) -> f64| over(&|g| g.points as f64 / seconds(g), f64::min);
    let rate = |points: f64| format!("{} points/s", millions(points));
    let to = format!("room of 10k to {} points", short(grown.last().map_or(0, |g| g.points)));
    let bytes = |b: f64| format!("{b:.0} bytes a point beyond 20 MB");
    let query = format!("{to}: query, median ≤ 2 × that at 10k");
    let prepare = format!("{to}: `Cloud::prepare` ≥ 2 M points/s");
    let memory = format!("{to}: memory: ≤ 200 bytes a point and 20 MB");
    vec![
        Target::at_most(query, over(&Grown::growth, f64::max), 2.0, ratio),
        Target::at_least(format!("{to}: tree ≥ 2 M points/s"), slowest(&|g| g.tree), 2e6, rate),
        Target::at_least(prepare, slowest(&|g| g.prepare), 2e6, rate),
        Target::at_most(memory, over(&Grown::bytes_a_point, f64::max), 200.0, bytes),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grown(points: usize, tree: f64, held: f64) -> Grown {
        let memory = Some(Memory { held, peak: 2.0 * held });
        Grown { points, asked: Vec::new(), tree, prepare: 2.0 * tree, memory }
    }

    #[test]
    fn the_worst_size_decides() {
        // 4 M and 2.5 M points a second; 0 and 180 bytes a point beyond 20 MB.
        let both = [grown(10_000, 0.0025, 15e6), grown(1_000_000, 0.4, 200e6)];
        let met: Vec<_> = targets(&both).iter().map(|target| target.met).collect();
        assert_eq!(met, [None, Some(true), Some(false), Some(true)]);
        assert!((both[1].bytes_a_point() - 180.0).abs() < 1e-9);
        assert_eq!(both[0].bytes_a_point(), 0.0);
    }
}
