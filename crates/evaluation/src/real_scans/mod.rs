//! `cargo xtask evaluate`: answers on real scans and along an approach.

mod approach;
pub(crate) mod cases;
mod labelled;
mod side_view;

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;

use crate::report::{Page, Part, page, targets};

/// What `cargo xtask evaluate` is given.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder with cases.json, clouds/ and meshes/, relative to the workspace
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    data: PathBuf,
    /// Write docs/lab/real-scans.md and its figures; else they go to target/lab/
    #[arg(long)]
    update_docs: bool,
}

const INTRODUCTION: &str = "Answers on real point clouds with labelled poses, and along an approach \
of a gripper to a mug. DIR is the folder of the scans, which are not part of the project.";

/// Runs every part, writes the page, and fails when a target is missed.
///
/// # Errors
/// When a target is missed, or files cannot be read or written.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Some(data) = cases::folder(root, &arguments.data) else { return Ok(()) };
    let names = ("real-scans", "Answers on real scans");
    let command = ("evaluate", "--data DIR --update-docs");
    // Nothing is drawn.
    let page = Page::new(names, command, INTRODUCTION, root, 0);
    let parts: [Part<'_>; 2] = [
        ("labelled poses", &|| labelled::evaluate(&data)),
        ("approach", &|| approach::evaluate(&data)),
    ];
    let folder = page::folder(root, arguments.update_docs);
    targets::require(&targets::report(page, &folder, "", &parts)?)
}
