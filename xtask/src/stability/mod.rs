//! `cargo xtask stability`: hard cases, maps of the solver's settings, and motions that must change
//! nothing, measured and judged against the goals.

mod cloud_cases;
mod document;
mod heat_map;
mod leaf;
mod maps;
mod motions;
mod other_cases;
mod reach;
mod sheet;
mod solver_cases;
mod tree_cases;

use std::{fs, path::Path, time::Instant};

use anyhow::{Context, Result, bail};
use clap::Args;

use sheet::Sheet;

/// All randomness of the run comes from this.
const SEED: u64 = 2011;
/// The relative gap that solves are asked for: that of reported figures.
const RELATIVE_GAP: f64 = 1e-4;

/// What `cargo xtask stability` is given.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Write docs/lab/stability.md and its figures; else figures go to target/stability/
    #[arg(long)]
    update_docs: bool,
}

/// Runs everything, prints the document, and fails when an answer is wrong or not sound.
pub(crate) fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let docs = root.join("docs/lab/figures");
    let figures = if arguments.update_docs { docs } else { root.join("target/stability") };
    fs::create_dir_all(&figures).with_context(|| format!("make {}", figures.display()))?;
    let start = Instant::now();
    let mut sheet = Sheet::default();
    for (name, part) in parts(&figures) {
        part(&mut sheet).with_context(|| format!("stability of {name}"))?;
        eprintln!("stability: {name} done after {:.0} s", start.elapsed().as_secs_f64());
    }
    let text = document::text(root, &sheet)?;
    print!("{text}");
    if arguments.update_docs {
        document::write(root, &text)?;
    }
    if !sheet.faults.is_empty() {
        bail!("{} answers are not sound:\n{}", sheet.faults.len(), sheet.faults.join("\n"));
    }
    Ok(())
}

type Part<'a> = Box<dyn Fn(&mut Sheet) -> Result<()> + 'a>;

/// The parts of a run in the order of the document.
fn parts(figures: &Path) -> Vec<(&'static str, Part<'_>)> {
    vec![
        ("solver cases", Box::new(solver_cases::run)),
        ("hierarchy cases", Box::new(tree_cases::run)),
        ("query cases", Box::new(cloud_cases::run)),
        ("meshes and poses", Box::new(other_cases::run)),
        ("maps", Box::new(|sheet| maps::run(sheet, figures))),
        ("default queries", Box::new(reach::run)),
        ("motions", Box::new(motions::run)),
    ]
}
