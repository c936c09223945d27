//! A pose as sixteen numbers in a text file.

use std::path::Path;

use anyhow::{Context, Result};
use cloudtouch::geom::Pose;
use cloudtouch_cli::files::pose;

use super::text;

pub(crate) fn read(path: &Path, max_bytes: u64) -> Result<Pose> {
    let text = text::read(path, "pose", max_bytes)?;
    pose::parse(&text).with_context(|| format!("{}", path.display()))
}
