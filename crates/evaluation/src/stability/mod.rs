//! `cargo xtask stability`: hard cases through the solver and whole queries, and motions that must
//! change nothing, judged against the targets.
//!
//! That bounds hold what all pairs of points say, and that no setting or unit breaks the solver, is
//! tested in the crates themselves.

mod motions;
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
    let page = Page::new(names, ("stability", "--update-docs"), INTRODUCTION, root, motions::SEED);
    let parts: [Part<'_>; 3] = [
        ("solver", &solver::measure),
        ("queries", &queries::measure),
        ("motions", &motions::measure),
    ];
    let folder = page::folder(root, arguments.update_docs);
    targets::require(&targets::report(page, &folder, "", &parts)?)
}
