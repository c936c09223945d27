//! `cargo xtask calibrate`: the constants that turn evidence into a probability.

use std::{fs, path::Path};

use anyhow::Result;
use clap::Args;

use crate::sweep::{answer, plan::Plan};

/// What `cargo xtask calibrate` is given.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Poses of each family; the same ones under every condition
    #[arg(long, default_value_t = 48)]
    poses: usize,
}

/// Gathers evidence and fits.
pub(crate) fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let folder = root.join("target/sweep");
    fs::create_dir_all(&folder)?;
    let answers = answer::all(&Plan::evidence(arguments.poses))?;
    answers.write_csv(&folder.join("evidence.csv"))?;
    Ok(())
}
