//! Project tasks: `cargo xtask TASK`, one file per task.

mod bench_report;
mod calibrate;
mod ci;
mod common;
mod fixtures;
mod sweep;
mod tidy;

use std::path::{Path, PathBuf};

use clap::Parser;
use cloudtouch_evaluation::{growth, real_scans, stability};

/// Project tasks.
#[derive(Parser)]
enum Task {
    /// Everything that must hold before a merge; stops at the first failure.
    Ci,
    /// Rules on manifests, layers and text that no compiler checks.
    Tidy,
    /// Answers on real scans and exact poses, with figures.
    Evaluate(real_scans::Arguments),
    /// Every method against exact truth on generated scenes, with tables and figures.
    Sweep(sweep::Arguments),
    /// Fits the constants that turn evidence into a probability.
    Calibrate(calibrate::Arguments),
    /// Hard cases, the solver over its settings, and motions that must change nothing.
    Stability(stability::Arguments),
    /// Times of ours and of its peers on the same scenes, against the targets, with figures.
    BenchReport(bench_report::Arguments),
    /// Answers to fixed poses in a real scan while noise is added to it.
    Growth(growth::Arguments),
    /// Query time against error, one setting changed at a time.
    Settings(sweep::SettingsArguments),
    /// Writes one of the sweep's large scenes to target/scenes/.
    Scene(fixtures::SceneArguments),
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
        Task::Evaluate(arguments) => real_scans::run(&root, &arguments),
        Task::Sweep(arguments) => sweep::run(&root, &arguments),
        Task::Calibrate(arguments) => calibrate::run(&root, &arguments),
        Task::Stability(arguments) => stability::run(&root, &arguments),
        Task::BenchReport(arguments) => bench_report::run(&root, &arguments),
        Task::Growth(arguments) => growth::run(&root, &arguments),
        Task::Settings(arguments) => sweep::settings(&root, &arguments),
        Task::Scene(arguments) => fixtures::write_scene(&root, &arguments),
        Task::Fixtures { check: true } => fixtures::check(&root),
        Task::Fixtures { check: false } => fixtures::write(&root),
    }
}

/// The folder of the workspace.
fn project_root() -> PathBuf {
    // Asked when run: two clones that share a target folder share this binary.
    let xtask = std::env::var_os("CARGO_MANIFEST_DIR")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    xtask.parent().map_or(xtask.clone(), Path::to_path_buf)
}
