//! `cargo xtask stability`: hard cases, the solver over its settings and over noise and units, and
//! motions that must change nothing, measured and judged against the goals.

mod default_queries;
mod examine;
mod grids;
mod motions;
mod queries;
mod shapes;
mod sheet;
mod solver;
mod solver_cases;
mod tree_cases;

use std::{path::Path, time::Instant};

use anyhow::{Context, Result, bail};
use clap::Args;

use crate::page::{self, Page, Section};
use sheet::{SEED, Sheet};

const INTRODUCTION: &str = "What the solver, the hierarchy and whole queries do with input that \
breaks careless numerics: no panic, no number that is not one, bounded work, and a verdict that is \
right or says that it is none. Apart from the times every number is the same in each run.";

/// What `cargo xtask stability` is given.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Write docs/lab/stability.md; else it goes to target/lab/
    #[arg(long)]
    update_docs: bool,
}

/// Adds its sections and goals.
type Part = fn(&mut Sheet) -> Result<()>;

/// Everything in the order of the page.
const PARTS: [(&str, Part); 6] = [
    ("solver cases", solver_cases::run),
    ("hierarchy cases", tree_cases::run),
    ("query cases", queries::run),
    ("grids of problems", grids::run),
    ("default queries", default_queries::run),
    ("motions", motions::run),
];

/// Runs everything, writes the page, and fails when a goal is missed or an answer is not sound.
///
/// # Errors
/// When a goal is missed, an answer is wrong or not sound, or the page cannot be written.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let start = Instant::now();
    let mut sheet = Sheet::default();
    for (name, part) in PARTS {
        part(&mut sheet).with_context(|| format!("stability of {name}"))?;
        eprintln!("stability: {name} done after {:.0} s", start.elapsed().as_secs_f64());
    }
    sheet.close();
    let names = ("stability", "Numerical stability");
    let mut page = Page::new(names, ("stability", "--update-docs"), INTRODUCTION, root, SEED);
    page.section(Section::new("Goals").text(sheet.goals()));
    if !sheet.faults.is_empty() {
        page.section(Section::new("Faults").text(format!("- {}", sheet.faults.join("\n- "))));
    }
    std::mem::take(&mut sheet.sections).into_iter().for_each(|section| page.section(section));
    page.write(&page::folder(root, arguments.update_docs))?;
    let missed = sheet.missed();
    if !missed.is_empty() {
        bail!("missed: {}\n{}", missed.join("; "), sheet.faults.join("\n"));
    }
    println!("stability: all goals are met");
    Ok(())
}
