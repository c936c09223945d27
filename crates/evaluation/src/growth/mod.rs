//! `cargo xtask growth`: answers to fixed poses in a real scan while noise is added to it, after
//! the paper's figure 5.

mod answers;
mod scan;

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use cloudtouch_geom::Pose;
use cloudtouch_io::{LengthUnit, read_mesh};

use crate::{
    figure::{Axis, Figure, Panel, Series},
    page::{self, Page, Section},
    real_scans::cases::{self, Labelled, at_advance},
    statistics::quantile,
    table::Table,
};
use answers::{ADDED, Answers, METHODS, OWN_STD};
use scan::Scan;

/// All randomness of the noise comes from this.
const SEED: u64 = 2011;
/// Poses that have come nearer to first contact than this are asked about, m.
const FARTHEST: f64 = 0.03;
/// How far past first contact the poses are that the figure shows, m.
const PICTURED: [f64; 3] = [-0.03, 0.0, 0.02];
/// Numbers of the added noises that have columns of their own: 5, 10 and 20 mm.
const SHOWN: [usize; 3] = [4, 6, 8];

/// What `cargo xtask growth` is given.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder with cases.json, clouds/ and meshes/, relative to the workspace
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    data: PathBuf,
    /// How often noise of each size is drawn
    #[arg(long, default_value_t = 12)]
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
    let data = root.join(&arguments.data);
    if !data.join("cases.json").is_file() {
        println!(
            "skipped: no real scans at {}; put cases.json, clouds/ and meshes/ there or name their \
             folder with --data DIR",
            arguments.data.display()
        );
        return Ok(());
    }
    let cases = cases::series(&data, -FARTHEST)?;
    let object = read_mesh(&cases[0].object, LengthUnit::Metres)?;
    let poses: Vec<Pose> = cases.iter().map(|case| case.scene_from_object).collect();
    let scan = Scan::read(&cases[0].scene, &scan::reach(&object, &poses))?;
    let answers = Answers::ask(&scan, &object, &poses, arguments.draws, SEED)?;
    let introduction = format!(
        "After the paper's figure 5: a gripper, known as a mesh, at {} poses of its approach to a \
         mug in a real scan, while normal noise is added to the {} measured points near it. Each \
         size of noise is drawn {} times. The sensor model is told of it ({:.0} mm for the scan \
         itself, plus what is added). DIR is the folder of the scans, which are not part of the \
         project.\n\n\
         `calibrated` and `paper` answer with a probability, in collision from ½ on. The others \
         say yes or no: a 1 cm box around a measured point touches the gripper; a measured point \
         is inside of it (its smallest signed distance is negative); a mesh of the scan (means of \
         4 × 4 pixels, joined where the scan without added noise has no edge) intersects it.",
        cases.len(),
        scan.len(),
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
                 of a probability. Lower right: how often the verdict on a pose differs from that \
                 of the draw before, over all poses.",
            )
            .figure("growth", "Answers while noise grows", figure(&cases, &answers)?)
            .text(
                "How often the verdict flips from draw to draw, and how often it is not the \
                 verdict on the scan as it is. Last: collisions stated of poses whose nearest \
                 measured point is more than 5 mm away (label `near`), and poses pushed 2 cm and \
                 more past first contact (label `collision`) of which none is stated; over all \
                 noises.",
            )
            .text(methods(&cases, &answers)),
    );
    page.section(
        Section::new("Mean answers by pose")
            .text(
                "Without added noise and with 10 mm of it; the advance is past first contact with \
                 a measured point.",
            )
            .text(by_pose(&cases, &answers)),
    );
    page.write(&page::folder(root, arguments.update_docs))
}

/// How far a pose is past first contact, and the smallest signed distance of a measured point.
fn place(case: &Labelled) -> String {
    let [advance, distance] = [case.advance_m(), case.distance].map(|length| 1e3 * length);
    format!("advance {advance:+.0} mm, nearest point {distance:+.0} mm")
}

fn figure(cases: &[Labelled], answers: &Answers) -> Result<Figure> {
    let x = || Axis::linear("std of the added noise (mm)");
    let mut figure = Figure::new("Answers while noise is added to a real scan");
    for advance in PICTURED {
        let pose = at_advance(cases, advance)?;
        let panel = Panel::new(x(), Axis::unit("probability or verdict"));
        let panel = panel.title(&place(&cases[pose]));
        figure = figure.panel((0..METHODS.len()).fold(panel, |panel, method| {
            let said = |level| answers.of(method, pose, level);
            let levels = ADDED.iter().enumerate().map(|(level, std)| (1e3 * std, said(level)));
            let levels: Vec<(f64, Vec<f64>)> = levels.collect();
            let means = levels.iter().map(|(x, said)| (*x, mean(said)));
            // Verdicts have no spread: their mean says how often they are which.
            let spread = levels
                .iter()
                .filter(|_| method < 2)
                .map(|(x, said)| (*x, quantile(said, 0.1), quantile(said, 0.9)));
            let name = METHODS[method];
            panel.series(Series::whiskers(name, spread)).series(Series::curve(name, means))
        }));
    }
    let flips = Panel::new(x(), Axis::linear("share of verdict changes"));
    Ok(figure.panel((0..METHODS.len()).fold(
        flips.title("verdicts that flip from draw to draw"),
        |panel, method| {
            let share = |level| share(flips_of(cases.len(), answers, method, level));
            let points = ADDED.iter().enumerate().map(|(level, std)| (1e3 * std, share(level)));
            panel.series(Series::curve(METHODS[method], points))
        },
    )))
}

fn methods(cases: &[Labelled], answers: &Answers) -> Table {
    let mm = |level: usize| format!("{:.0} mm", 1e3 * ADDED[level]);
    let mut header = vec!["method".to_owned()];
    header.extend(SHOWN.map(|level| format!("flips at {}", mm(level))));
    header.extend(SHOWN.map(|level| format!("changed by {}", mm(level))));
    header.extend(["false stops", "misses"].map(String::from));
    let mut table = Table::new(header);
    for (method, name) in METHODS.iter().enumerate() {
        let verdicts = |pose, level| answers.verdicts(method, pose, level);
        let changed = |level| {
            (0..cases.len()).flat_map(move |pose| {
                let plain = verdicts(pose, 0)[0];
                verdicts(pose, level).into_iter().map(move |verdict| verdict != plain)
            })
        };
        let wrong = |label: &str, verdict: bool| {
            let of_label = (0..cases.len()).filter(|&pose| cases[pose].label == label);
            let said = of_label
                .flat_map(|pose| (0..ADDED.len()).flat_map(move |level| verdicts(pose, level)));
            share(said.map(|said| said == verdict).collect::<Vec<_>>())
        };
        let mut cells = vec![(*name).to_owned()];
        cells.extend(SHOWN.map(|level| {
            let flips = flips_of(cases.len(), answers, method, level);
            format!("{} of {}", flips.iter().filter(|flip| **flip).count(), flips.len())
        }));
        cells.extend(SHOWN.map(|level| format!("{:.3}", share(changed(level)))));
        let wrong = [wrong("near", true), wrong("collision", false)];
        cells.extend(wrong.map(|share| format!("{share:.3}")));
        table.row(cells);
    }
    table
}

fn by_pose(cases: &[Labelled], answers: &Answers) -> Table {
    let mut table = Table::new(std::iter::once("pose").chain(METHODS));
    for (pose, case) in cases.iter().enumerate() {
        let mean = |method, level| mean(&answers.of(method, pose, level));
        let cell = |method| format!("{:.2}, {:.2}", mean(method, 0), mean(method, SHOWN[1]));
        table.row(std::iter::once(place(case)).chain((0..METHODS.len()).map(cell)));
    }
    table
}

/// Whether each verdict differs from that of the draw before, within the draws of a pose.
fn flips_of(poses: usize, answers: &Answers, method: usize, level: usize) -> Vec<bool> {
    let of_pose = |pose| changes(&answers.verdicts(method, pose, level));
    (0..poses).flat_map(of_pose).collect()
}

fn changes(verdicts: &[bool]) -> Vec<bool> {
    verdicts.windows(2).map(|pair| pair[0] != pair[1]).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn share(of: impl IntoIterator<Item = bool>) -> f64 {
    let each: Vec<f64> = of.into_iter().map(|is| f64::from(u8::from(is))).collect();
    mean(&each)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_counted_between_neighbours() {
        assert_eq!(changes(&[true, true, false, true]), [false, true, true]);
        assert!(changes(&[true]).is_empty() && changes(&[]).is_empty());
        assert_eq!(share(changes(&[true, true, false, true])), 2.0 / 3.0);
        assert!(share(changes(&[true])).is_nan());
    }
}
