//! `cargo xtask growth`: answers to fixed poses in a real scan while noise is added to it, after
//! the paper's figure 5.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use cloudtouch_geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3, seed};
use cloudtouch_io::{LengthUnit, read_cloud, read_mesh};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use rayon::prelude::*;

use crate::answers::Pair;
use crate::methods::{Boxes, Distance, Draw, Method, Ours, Paper, observed};
use crate::real_scans::cases::{self, at_advance};
use crate::report::{Axis, Figure, Page, Panel, Section, Series, page};
use crate::statistics::quantile;

/// All randomness of the noise comes from this.
const SEED: u64 = 2011;
/// Standard deviation of the noise that the scan itself is said to have, m.
const OWN_STD: f64 = 0.005;
/// Standard deviations of the noise that is added, mm.
const ADDED: [f64; 4] = [0.0, 5.0, 10.0, 20.0];
/// What is near poses that are farther from first contact than this is left out, mm.
const FARTHEST: f64 = -30.0;
/// How far past first contact the poses are that are asked about, mm.
const ADVANCES: [f64; 3] = [-30.0, 0.0, 20.0];
/// The first two say a probability.
const METHODS: [&str; 4] = ["calibrated", "paper", "1 cm boxes", "points inside the mesh"];

/// What `cargo xtask growth` is given.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder with cases.json, clouds/ and meshes/, relative to the workspace
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    data: PathBuf,
    /// How often noise of each size is drawn
    #[arg(long, default_value_t = 4)]
    draws: u64,
    /// Write docs/lab/growth.md and its figure; else they go to target/lab/
    #[arg(long)]
    update_docs: bool,
}

/// Asks all methods and writes the page.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Some(data) = cases::folder(root, &arguments.data) else { return Ok(()) };
    let mut series = cases::series(&data)?;
    series.retain(|(advance, _)| *advance >= FARTHEST);
    let object = read_mesh(&series[0].1.object, LengthUnit::Metres)?;
    let placed = |pose: &Pose| {
        object.vertices().iter().map(|v| pose.transform_point(v)).collect::<Vec<Point3>>()
    };
    let around = series.iter().flat_map(|(_, case)| placed(&case.pose)).collect();
    let scan = read_near(&series[0].1.scene, around)?;
    let asked = ADVANCES.map(|advance| at_advance(&series, advance));
    let asked = asked.into_iter().collect::<Result<Vec<usize>>>()?;
    let poses: Vec<Pose> = asked.iter().map(|&i| series[i].1.pose).collect();
    let levels = ADDED.into_iter().map(|added| {
        let of_draw = |draw| of_draw(&scan, 1e-3 * added, draw, &object, &poses);
        (0..arguments.draws).into_par_iter().map(of_draw).collect()
    });
    let levels: Vec<Vec<OfDraw>> = levels.collect::<Result<_>>()?;
    let panels = asked.iter().enumerate().map(|(which, &pose)| {
        let (advance, case) = &series[pose];
        let nearest = case.distance_mm;
        let side = if nearest > 0.0 { "outside" } else { "inside" };
        let title =
            format!("advance {advance:+.0} mm: nearest point {:.0} mm {side}", nearest.abs());
        panel(title, |method, level| levels[level].iter().map(|of| of[which][method]).collect())
    });
    let figure = Figure::new(
        "What each method says of a gripper before, at and in a mug while noise is added to the scan: 1 is collision",
        panels,
    );
    let introduction = format!(
        "After the paper's figure 5: a gripper, known as a mesh, at {} poses of its approach to a \
         mug in a real scan, while normal noise is added to the {} measured points near it. Each \
         size of noise is drawn {} times. The sensor model is told of it ({:.0} mm for the scan \
         itself, plus what is added). DIR is the folder of the scans, which are not part of the \
         project.\n\n\
         `calibrated` and `paper` answer with a probability, in collision from ½ on. The others \
         say yes or no: a 1 cm box around a measured point touches the gripper; a measured point \
         is inside of it (its smallest signed distance is negative).",
        poses.len(),
        scan.points.iter().filter(|p| p.x.is_finite()).count(),
        arguments.draws,
        1e3 * OWN_STD,
    );
    let names = ("growth", "Answers while noise grows");
    let command = ("growth", "--data DIR --update-docs");
    let mut page = Page::new(names, command, &introduction, root, SEED);
    let lines = "Lines are means over the draws, bars reach from the 10th to the 90th percentile of a \
                 probability.";
    let section = Section::new("Answers by noise").text(lines);
    page.section(section.figure("growth", "Answers while noise grows", figure));
    page.write(&page::folder(root, arguments.update_docs))
}

/// Reads a depth image and forgets what is farther than 10 cm from a box around these points.
fn read_near(path: &Path, around: Vec<Point3>) -> Result<PointCloud> {
    const MARGIN: f64 = 0.1;
    let mut scan = read_cloud(path)?;
    let corners = PointCloud::from_points(around).bounding_box().context("nothing to be near")?;
    let (low, high) = (corners.0.map(|v| v - MARGIN), corners.1.map(|v| v + MARGIN));
    for point in scan.points.iter_mut().filter(|p| !(low < **p && **p < high)) {
        *point = Vector3::repeat(f64::NAN).into();
    }
    Ok(scan)
}

/// The answers of all methods to all poses: a probability, or 0 and 1 of a yes-or-no method.
type OfDraw = Vec<[f64; METHODS.len()]>;

fn of_draw(
    scan: &PointCloud,
    added: f64,
    draw: u64,
    object: &TriangleMesh,
    poses: &[Pose],
) -> Result<OfDraw> {
    // Those of one draw differ in nothing but their size.
    let points = add_noise(&scan.points, NoiseKind::Gaussian, added, seed::derive(SEED, 5, draw));
    // Whoever adds noise tells the sensor model.
    let a = observed(PointCloud { points, ..scan.clone() }, OWN_STD.hypot(added));
    // Asked as a mesh; a cloud of it has to be there nevertheless.
    let b = observed(PointCloud::from_points(object.vertices().to_vec()), 0.0);
    let draw = Draw { family: "real scan", a: &a, b: &b, mesh: object };
    let methods: [&dyn Method; METHODS.len()] = [
        &Ours::new(METHODS[0])?,
        &Paper::new(METHODS[1]),
        &Boxes { side: 0.01 },
        &Distance { smoothed: false },
    ];
    let mut answers = vec![[0.0; METHODS.len()]; poses.len()];
    for (which, method) in methods.into_iter().enumerate() {
        let ask = method.prepare(&draw)?;
        for (said, pose) in answers.iter_mut().zip(poses) {
            let answer = ask(Pair::CloudMesh, pose)?.context("no answer about a mesh")?;
            // A score above 0: a box that touches, a point inside.
            said[which] = answer.probability.unwrap_or(f64::from(u8::from(answer.score > 0.0)));
        }
    }
    Ok(answers)
}

/// The answers to one pose by added noise; `said` are those of a method at one of them, by draw.
fn panel(title: String, said: impl Fn(usize, usize) -> Vec<f64>) -> Panel {
    let mut series = Vec::new();
    for (method, name) in METHODS.iter().enumerate() {
        let said: Vec<_> =
            (0..).zip(ADDED).map(|(level, added)| (added, said(method, level))).collect();
        // Verdicts have no spread: their mean says how often they are which.
        let spread = said.iter().filter(|_| method < 2);
        let spread = spread.map(|(added, p)| (*added, quantile(p, 0.1), quantile(p, 0.9)));
        let mean = |p: &[f64]| p.iter().sum::<f64>() / p.len() as f64;
        series.push(Series::whiskers(name, spread));
        series.push(Series::curve(name, said.iter().map(|(added, p)| (*added, mean(p)))));
    }
    let x = Axis::linear("std of the added noise (mm)");
    Panel { title, x, y: Axis::unit("probability or verdict"), series }
}
