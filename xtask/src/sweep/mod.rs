//! `cargo xtask sweep`: collision probabilities of many scenes, noises and methods against exact
//! truth.

pub(crate) mod answer;
mod coverage;
mod document;
mod figures;
mod growth;
pub(crate) mod measures;
mod ours;
pub(crate) mod plan;
pub(crate) mod plots;
pub(crate) mod record;
mod resample;
pub(crate) mod rivals;
mod settings;
mod short;
mod tables;
mod targets;
pub(crate) mod variant;

use std::{fs, path::Path};

use anyhow::{Context, Result};
use clap::Args;

pub(crate) use growth::{Arguments as GrowthArguments, run as growth};
use measures::calibrate_scores;
use plan::Plan;
pub(crate) use settings::{Arguments as SettingsArguments, run as settings};

/// All randomness of the sweep comes from this.
const SEED: u64 = 2011;
/// What ours is called in tables and files.
pub(crate) const OURS: &str = "calibrated";
/// ... and ours given every sampled point as it truly is.
pub(crate) const ORACLE: &str = "oracle";
/// Poses of each family whose bounds are compared with a search of everything.
const COVERAGE_POSES: usize = 32;
/// Pairs of clouds drawn for one pose.
const RESAMPLED: u64 = 100;

/// What `cargo xtask sweep` is given.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Poses of each family; the same ones under every condition
    #[arg(long, default_value_t = 48)]
    poses: usize,
    /// Only the coverage of bounds and the spread over fresh clouds, printed
    #[arg(long, conflicts_with_all = ["short", "update_docs"])]
    checks: bool,
    /// A few conditions only, compared with recorded bounds; what CI runs
    #[arg(long)]
    short: bool,
    /// Write docs/lab/accuracy.md and its figures; else everything goes to target/sweep/
    #[arg(long, conflicts_with = "short")]
    update_docs: bool,
}

/// The short sweep: fails when accuracy gets worse than recorded.
pub(crate) fn check() -> Result<()> {
    short::run()
}

/// Runs the sweep, prints the tables and writes files and figures.
pub(crate) fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    if arguments.short {
        return check();
    }
    if arguments.checks {
        checks()?.iter().for_each(|section| println!("## {}\n\n{}", section.title, section.text));
        return Ok(());
    }
    let folder = root.join("target/sweep");
    let figures =
        if arguments.update_docs { root.join("docs/lab/figures") } else { folder.clone() };
    for place in [&folder, &figures] {
        fs::create_dir_all(place).with_context(|| format!("make {}", place.display()))?;
    }
    let mut answers = answer::all(&Plan::full(arguments.poses))?;
    calibrate_scores(&mut answers)?;
    answers.write_csv(&folder.join("answers.csv"))?;
    let mut sections = vec![targets::section(&answers)];
    sections.extend(tables::sections(&answers, &folder)?);
    sections.extend(checks()?);
    figures::draw(&answers, &figures)?;
    let text = document::text(root, arguments.poses, &sections)?;
    print!("{text}");
    if arguments.update_docs {
        document::write(root, &text)?;
    }
    Ok(())
}

/// What is measured beside the table of answers.
fn checks() -> Result<[tables::Section; 2]> {
    Ok([coverage::section(COVERAGE_POSES)?, resample::section(RESAMPLED)?])
}
