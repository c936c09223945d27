//! `cargo xtask growth`: answers to fixed poses in a real scan while noise is added to it, after
//! the paper's figure 5.

mod answers;
mod document;
mod flips;
mod plot;
mod scan;

use std::{
    fs,
    path::{Path, PathBuf},
};

use anyhow::{Context, Result};
use clap::Args;
use cloudtouch_geom::{Pose, TriangleMesh};
use cloudtouch_io::{LengthUnit, read_mesh};
use nalgebra::Matrix4;

use super::{SEED, measures::Bootstrap};
use crate::{
    common::files::write_whole,
    evaluate::case_file::{Case, CaseFile},
};
use answers::{ADDED, METHODS, Table};
use flips::flips;
use plot::Growth;
use scan::{Scan, reach};

/// Poses that have come nearer to first contact than this are asked about, m.
const FARTHEST: f64 = 0.03;
/// How far past first contact the poses are that the figure shows, m.
const SHOWN: [f64; 3] = [-0.03, 0.0, 0.02];

/// What `cargo xtask growth` is given.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Folder with cases.json, clouds/ and meshes/, relative to the workspace
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    data: PathBuf,
    /// How often noise of each size is drawn
    #[arg(long, default_value_t = 12)]
    draws: u64,
    /// Write docs/lab/growth.md and its figure; else everything goes to target/growth/
    #[arg(long)]
    update_docs: bool,
}

/// Asks all methods, prints the table and draws the figure.
pub(crate) fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let data = root.join(&arguments.data);
    if !data.join("cases.json").is_file() {
        println!(
            "skipped: no real scans at {}; put cases.json, clouds/ and meshes/ there or name their \
             folder with --data DIR",
            arguments.data.display()
        );
        return Ok(());
    }
    let file = CaseFile::read(&data.join("cases.json"))?;
    let series = file.only(&data, |case| {
        case.series.is_some() && case.advance_past_first_contact_m.is_some_and(|a| a >= -FARTHEST)
    });
    let cases = series.cases;
    let first = cases.first().context("there is no approach series in cases.json")?;
    let object: TriangleMesh = read_mesh(&first.object, LengthUnit::Metres)?;
    let poses = cases.iter().map(pose).collect::<Result<Vec<Pose>>>()?;
    let scan = Scan::read(Path::new(&first.scene), &reach(&object, &poses))?;
    let table = Table::ask(&scan, &object, &poses, arguments.draws)?;

    let figures =
        root.join(if arguments.update_docs { "docs/lab/figures" } else { "target/growth" });
    fs::create_dir_all(&figures).with_context(|| format!("make {}", figures.display()))?;
    draw(&figures.join("growth.svg"), &cases, &table)?;
    let text = document::text(root, (scan.len(), arguments.draws), &cases, &table)?;
    print!("{text}");
    let folder = if arguments.update_docs { root.join("docs/lab") } else { figures };
    write_whole(&folder.join("growth.md"), text)
}

fn pose(case: &Case) -> Result<Pose> {
    let matrix = Matrix4::from_fn(|row, column| case.pose[row][column]);
    Pose::try_from_matrix(&matrix).with_context(|| format!("case {}", case.id))
}

fn draw(path: &Path, cases: &[Case], table: &Table) -> Result<()> {
    let levels = |of: &dyn Fn(usize) -> Vec<f64>| -> Vec<(f64, Vec<f64>)> {
        ADDED.iter().enumerate().map(|(level, std)| (1e3 * std, of(level))).collect()
    };
    let mut shown = Vec::new();
    for wanted in SHOWN {
        let is_wanted =
            |c: &Case| c.advance_past_first_contact_m.is_some_and(|a| (a - wanted).abs() < 1e-6);
        let pose = cases.iter().position(is_wanted).context("no case is where one is wanted")?;
        shown.push(Growth {
            title: document::place(&cases[pose]),
            methods: (0..METHODS.len())
                .map(|method| levels(&|level| table.of(method, pose, level)))
                .collect(),
        });
    }
    let flipped: Vec<_> = (0..METHODS.len())
        .map(|method| {
            let of_level = |(level, std): (usize, &f64)| {
                let poses = 0..cases.len();
                let series: Vec<Vec<bool>> =
                    poses.map(|pose| table.verdicts(method, pose, level)).collect();
                (1e3 * std, flips(&series, Bootstrap::new(SEED)))
            };
            ADDED.iter().enumerate().map(of_level).collect()
        })
        .collect();
    plot::growth(path, &METHODS, &shown, &flipped)
}
