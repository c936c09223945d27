//! Project tasks: `cargo xtask TASK`. What measures is in crates/evaluation.

mod cargo;
mod ci;
mod fixtures;
mod python;
mod tidy;

use std::path::{Path, PathBuf};

use clap::Parser;
use cloudtouch_evaluation::{calibrate, motion, paper, performance, real_scans, sweep};

/// Project tasks.
#[derive(Parser)]
enum Task {
    /// Everything that must hold before a merge; stops at the first failure.
    Ci,
    /// Rules on manifests, layers and text that no compiler checks.
    Tidy,
    /// The Python package: built, its types checked, its tests run; skipped where there is no Python.
    Python,
    /// Answers of the tool on real scans and exact poses, with figures.
    Evaluate(real_scans::Arguments),
    /// Every method against exact truth on generated scenes, with tables and figures.
    Sweep(sweep::Arguments),
    /// Fits the constants that turn evidence into a probability.
    Calibrate(calibrate::Arguments),
    /// Times of ours and of its peers on the same scenes, against the targets, with figures.
    BenchReport(performance::Arguments),
    /// The figures of the paper with our data, by its method as printed and by ours.
    Paper(paper::Arguments),
    /// How right margins, normals of contacts, ways out and gradients are, against exact truth.
    Motion(motion::Arguments),
    /// Makes the files of fixtures/ anew.
    Fixtures {
        /// Compares with the stored files and writes nothing.
        #[arg(long)]
        check: bool,
    },
}

fn main() -> anyhow::Result<()> {
    let root = project_root();
    match Task::parse() {
        Task::Ci => ci::run(&root),
        Task::Tidy => tidy::run(&root),
        Task::Python => python::run(&root),
        Task::Evaluate(arguments) => real_scans::run(&root, &arguments),
        Task::Sweep(arguments) => sweep::run(&root, &arguments),
        Task::Calibrate(arguments) => calibrate::run(&root, &arguments),
        Task::BenchReport(arguments) => performance::run(&root, &arguments),
        Task::Paper(arguments) => paper::run(&root, &arguments),
        Task::Motion(arguments) => motion::run(&root, &arguments),
        Task::Fixtures { check } => fixtures::run(&root, check),
    }
}

/// The folder of the workspace.
fn project_root() -> PathBuf {
    // Asked when run: two clones that share a target folder share this binary.
    let xtask = std::env::var_os("CARGO_MANIFEST_DIR")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    xtask.parent().map_or(xtask.clone(), Path::to_path_buf)
}
