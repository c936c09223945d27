//! `cargo xtask growth`: answers to fixed poses in a real scan while noise is added to it, after
//! the paper's figure 5.

mod answers;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use cloudtouch_geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch_io::{LengthUnit, read_cloud, read_mesh};

use crate::{
    figure::{Axis, Figure, Panel, Series},
    page::{self, Page, Section},
    real_scans::cases::{self, Labelled, at_advance},
    statistics::quantile,
    table::Table,
};
use answers::{ADDED, Answers, METHODS, OWN_STD, SEED};

/// Poses that are farther from first contact than this are left out, mm.
const FARTHEST: f64 = -30.0;
/// How far past first contact the poses are that the figure shows, mm.
const PICTURED: [f64; 3] = [-30.0, 0.0, 20.0];

/// The poses with how far past first contact they are, mm.
type Poses = [(f64, Labelled)];

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
///
/// # Errors
/// When files cannot be read or written, or a method has no answer.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Some(data) = cases::folder(root, &arguments.data) else { return Ok(()) };
    let mut series = cases::series(&data)?;
    series.retain(|(advance, _)| *advance >= FARTHEST);
    let object = read_mesh(&series[0].1.object, LengthUnit::Metres)?;
    let poses: Vec<Pose> = series.iter().map(|(_, case)| case.pose).collect();
    let placed =
        |pose: &Pose| object.vertices().iter().map(|v| pose.transform_point(v)).collect::<Vec<_>>();
    let scan = read_near(&series[0].1.scene, poses.iter().flat_map(placed).collect())?;
    let answers = Answers::ask(&scan, &object, &poses, arguments.draws)?;
    let introduction = format!(
        "After the paper's figure 5: a gripper, known as a mesh, at {} poses of its approach to a \
         mug in a real scan, while normal noise is added to the {} measured points near it. Each \
         size of noise is drawn {} times. The sensor model is told of it ({:.0} mm for the scan \
         itself, plus what is added). DIR is the folder of the scans, which are not part of the \
         project.\n\n\
         `calibrated` and `paper` answer with a probability, in collision from ½ on. The others \
         say yes or no: a 1 cm box around a measured point touches the gripper; a measured point \
         is inside of it (its smallest signed distance is negative).",
        series.len(),
        scan.points.iter().filter(|p| p.x.is_finite()).count(),
        arguments.draws,
        1e3 * OWN_STD,
    );
    let names = ("growth", "Answers while noise grows");
    let command = ("growth", "--data DIR --update-docs");
    let mut page = Page::new(names, command, &introduction, root, SEED);
    page.section(
        Section::new("Answers by noise")
            .text(
                "Lines are means over the draws, bars reach from the 10th to the 90th percentile \
                 of a probability.",
            )
            .figure("growth", "Answers while noise grows", figure(&series, &answers)?)
            .text(
                "How often the verdict flips from draw to draw; then collisions stated of poses whose nearest \
                 measured point is more than 5 mm away (label `near`), and poses pushed 2 cm and \
                 more past first contact (label `collision`) of which none is stated; over all \
                 noises.",
            )
            .text(methods(&series, &answers)),
    );
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

/// How far a pose is past first contact, and the smallest signed distance of a measured point.
fn place((advance, case): &(f64, Labelled)) -> String {
    format!("advance {advance:+.0} mm, nearest point {:+.0} mm", case.distance_mm)
}

fn figure(poses: &Poses, answers: &Answers) -> Result<Figure> {
    let panel = |advance: f64| {
        let pose = at_advance(poses, advance)?;
        let mut series = Vec::new();
        for (method, name) in METHODS.iter().enumerate() {
            let levels = ADDED.into_iter().enumerate();
            let said: Vec<_> =
                levels.map(|(level, added)| (added, answers.of(method, pose, level))).collect();
            // Verdicts have no spread: their mean says how often they are which.
            let spread = said.iter().filter(|_| method < 2);
            let span = |(added, said): &(f64, Vec<f64>)| {
                (*added, quantile(said, 0.1), quantile(said, 0.9))
            };
            series.push(Series::whiskers(name, spread.map(span)));
            series.push(Series::curve(name, said.iter().map(|(added, said)| (*added, mean(said)))));
        }
        let x = Axis::linear("std of the added noise (mm)");
        let y = Axis::unit("probability or verdict");
        Ok(Panel { title: place(&poses[pose]), x, y, series })
    };
    let panels: Vec<Panel> = PICTURED.into_iter().map(panel).collect::<Result<_>>()?;
    Ok(Figure::new("Answers while noise is added to a real scan", panels))
}

fn methods(poses: &Poses, answers: &Answers) -> Table {
    let flips = ADDED[1..].iter().map(|added| format!("flips at {added} mm"));
    let header = std::iter::once("method".to_owned()).chain(flips);
    let mut table = Table::new(header.chain(["false stops".into(), "misses".into()]));
    for (method, name) in METHODS.iter().enumerate() {
        let verdicts = |pose, level| -> Vec<bool> {
            answers.of(method, pose, level).iter().map(|p| *p >= 0.5).collect()
        };
        let stated = |label: &str, verdict: bool| {
            let of_label = (0..poses.len()).filter(|&pose| poses[pose].1.label == label);
            let all = of_label.flat_map(|pose| (0..ADDED.len()).map(move |level| (pose, level)));
            let said = all.flat_map(|(pose, level)| verdicts(pose, level));
            mean(&said.map(|said| f64::from(u8::from(said == verdict))).collect::<Vec<_>>())
        };
        let mut cells = vec![(*name).to_owned()];
        cells.extend((1..ADDED.len()).map(|level| {
            let of_poses: Vec<Vec<bool>> =
                (0..poses.len()).map(|pose| verdicts(pose, level)).collect();
            let pairs = || of_poses.iter().flat_map(|said| said.windows(2));
            format!("{} of {}", pairs().filter(|pair| pair[0] != pair[1]).count(), pairs().count())
        }));
        let shares = [stated("near", true), stated("collision", false)];
        cells.extend(shares.map(|share| format!("{share:.3}")));
        table.row(cells);
    }
    table
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
