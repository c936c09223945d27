//! `cargo xtask stability`: hard cases through the solver and whole queries, judged against the
//! targets.
//!
//! That bounds hold what all pairs of points say, that no setting or unit breaks the solver, and that
//! moving, turning, scaling, swapping and permuting change nothing, is tested in the crates themselves.

mod queries;
mod solver;

use std::path::Path;

use anyhow::Result;
use clap::Args;

use crate::report::{Page, Part, page, targets};

const INTRODUCTION: &str = "What the solver and whole queries do with input that breaks careless \
numerics: no panic, no number that is not one, bounded work, and a verdict that is right or says \
that it is none. Apart from the times every number is the same in each run.";

/// What `cargo xtask stability` is given.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Write docs/lab/stability.md; else it goes to target/lab/
    #[arg(long)]
    update_docs: bool,
}

/// Runs everything, writes the page, and fails when a target is missed.
///
/// # Errors
/// When a target is missed, or the page cannot be written.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let names = ("stability", "Numerical stability");
    // Nothing is drawn.
    let page = Page::new(names, ("stability", "--update-docs"), INTRODUCTION, root, 0);
    let parts: [Part<'_>; 2] = [("solver", &solver::measure), ("queries", &queries::measure)];
    let folder = page::folder(root, arguments.update_docs);
    targets::require(&targets::report(page, &folder, "", &parts)?)
}
