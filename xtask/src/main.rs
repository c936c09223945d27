//! Project tasks: `cargo xtask TASK`, one file per task.

mod calibrate;
mod ci;
mod common;
mod evaluate;
mod fixtures;
mod stability;
mod sweep;
mod tidy;

use std::path::{Path, PathBuf};

use clap::Parser;

/// Project tasks.
#[derive(Parser)]
enum Task {
    /// Everything that must hold before a merge; stops at the first failure.
    Ci,
    /// Rules on manifests, layers and text that no compiler checks.
    Tidy,
    /// Answers of the tool on real scans and exact poses, with figures.
    Evaluate(evaluate::Arguments),
    /// Every method against exact truth on generated scenes, with tables and figures.
    Sweep(sweep::Arguments),
    /// Fits the constants that turn evidence into a probability.
    Calibrate(calibrate::Arguments),
    /// Hard cases, maps of the solver and motions that must change nothing, with figures.
    Stability(stability::Arguments),
    /// Times of ours and of its peers on the same scenes, against the targets, with figures.
    BenchReport(cloudtouch_evaluation::performance::Arguments),
    /// Answers to fixed poses in a real scan while noise is added to it.
    Growth(sweep::GrowthArguments),
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
        Task::Evaluate(arguments) => evaluate::run(&root, &arguments),
        Task::Sweep(arguments) => sweep::run(&root, &arguments),
        Task::Calibrate(arguments) => calibrate::run(&root, &arguments),
        Task::Stability(arguments) => stability::run(&root, &arguments),
        Task::BenchReport(arguments) => cloudtouch_evaluation::performance::run(&root, &arguments),
        Task::Growth(arguments) => sweep::growth(&root, &arguments),
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
