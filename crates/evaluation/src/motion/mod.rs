//! `cargo xtask motion`: how well stated what goes beyond the collision at one pose is.

mod gradient;
mod margins;
mod near_contact;
mod normals;
mod penetration;

use std::path::Path;

use anyhow::Result;
use clap::Args;

use crate::SEED;
use crate::report::{Page, Part, page, targets};

/// What `cargo xtask motion` is given.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Draws of each family
    #[arg(long, default_value_t = 3)]
    draws: u32,
    /// Poses of each draw
    #[arg(long, default_value_t = 20)]
    poses: usize,
    /// Fit the log odds of margins to other draws first, and print them
    #[arg(long)]
    fit: bool,
    /// Write docs/lab/motion.md; else it goes to target/lab/
    #[arg(long)]
    update_docs: bool,
}

const INTRODUCTION: &str = "What a query says of margins, of contacts, of ways out of a collision and of \
gradients, judged against the exact surfaces of generated scenes and against queries at poses a little aside.";

/// Fits where asked to, measures, and writes the page.
///
/// # Errors
/// When a query fails or the page cannot be written.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Arguments { draws, poses, fit, update_docs } = *arguments;
    if fit {
        margins::fit(draws, poses)?;
    }
    let command = format!("--draws {draws} --poses {poses} --update-docs");
    let title = "Margins, contacts, penetration, gradients";
    let page = Page::new(("motion", title), ("motion", &command), INTRODUCTION, root, SEED);
    let parts: [Part<'_>; 4] = [
        ("margins", &|| margins::measure(draws, poses)),
        ("normals", &|| normals::measure(draws, poses)),
        ("penetration", &|| penetration::measure(draws, poses)),
        ("gradients", &|| gradient::measure(draws, poses)),
    ];
    targets::report(page, &page::folder(root, update_docs), "", &parts).map(drop)
}
