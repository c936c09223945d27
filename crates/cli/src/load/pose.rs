//! A pose as sixteen numbers in a text file.

use std::path::Path;

use anyhow::{Context, Result};
use cloudtouch::geom::Pose;
use cloudtouch_cli::files::pose;

pub(crate) fn read(path: &Path) -> Result<Pose> {
    let text = std::fs::read_to_string(path)
        .with_context(|| format!("{}: cannot read the pose", path.display()))?;
    pose::parse(&text).with_context(|| format!("{}", path.display()))
}
