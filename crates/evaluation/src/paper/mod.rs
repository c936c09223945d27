//! `cargo xtask paper`: the figures of the paper with our data, by its method as printed and by ours.

mod piano;
mod surfaces;

use std::path::Path;

use anyhow::Result;
use clap::Args;

use crate::SEED;
use crate::report::{Page, page};

/// What `cargo xtask paper` is given.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Poses of the piano
    #[arg(long, default_value_t = 100)]
    poses: usize,
    /// Points of a cloud
    #[arg(long, default_value_t = 10_000)]
    points: usize,
    /// Write docs/lab/paper.md and its figures; else they go to target/lab/
    #[arg(long)]
    update_docs: bool,
}

/// Draws every figure and writes the page.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Arguments { poses, points, update_docs } = *arguments;
    let introduction = "The figures of the paper that show what its method does, drawn anew with our \
        scenes. `printed` is the paper's mode at its defaults, `amended` the same with all our \
        amendments (`PaperSettings::amended`), `default` the product's own path. Figure 5 is \
        the approach in [real-scans.md](real-scans.md), the limit of figure 3 c a test \
        (`query/tests/paper_switches.rs`).";
    let command = format!("--poses {poses} --points {points} --update-docs");
    let title = ("paper", "The paper's figures");
    let mut page = Page::new(title, ("paper", &command), introduction, root, SEED);
    page.section(surfaces::section()?);
    page.section(piano::section(points, poses)?);
    page.write(&page::folder(root, update_docs))
}
