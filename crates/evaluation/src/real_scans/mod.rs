//! `cargo xtask evaluate`: answers on real scans, along an approach, and on sampled meshes.

mod approach;
pub(crate) mod cases;
mod labelled;
mod piano;
mod side_view;

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::Args;

use crate::page::{self, Page, Section};

/// What `cargo xtask evaluate` is given.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder with cases.json, piano_cases.json, clouds/ and meshes/, relative to the workspace
    #[arg(long, value_name = "DIR", default_value = "../shared/data")]
    data: PathBuf,
    /// Write docs/lab/real-scans.md and its figures; else they go to target/lab/
    #[arg(long)]
    update_docs: bool,
}

/// Runs every part, writes the page, and fails when a check does.
///
/// # Errors
/// When a check fails, or files cannot be read or written.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Some(data) = cases::folder(root, &arguments.data) else { return Ok(()) };
    let names = ("real-scans", "Answers on real scans");
    let introduction = "Answers on real point clouds with labelled poses, along an approach of a \
                        gripper to a mug, and on sampled meshes whose exact answers are known. DIR \
                        is the folder of the scans, which are not part of the project.";
    let command = ("evaluate", "--data DIR --update-docs");
    let mut page = Page::new(names, command, introduction, root, piano::SEED);
    let mut failures = Vec::new();
    let mut sections = Vec::new();
    for part in [labelled::evaluate, approach::evaluate, piano::evaluate] {
        let (section, failed) = part(&data)?;
        sections.push(section);
        failures.extend(failed);
    }
    let failed = format!("Failed:\n\n- {}", failures.join("\n- "));
    let verdict = if failures.is_empty() { "All hold." } else { &failed };
    page.section(Section::new("Checks").text(verdict));
    sections.into_iter().for_each(|section| page.section(section));
    page.write(&page::folder(root, arguments.update_docs))?;
    if !failures.is_empty() {
        bail!("{} checks failed\n  {}", failures.len(), failures.join("\n  "));
    }
    Ok(())
}
