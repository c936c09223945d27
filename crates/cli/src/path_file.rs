//! A path in a file.

use anyhow::{Context, Result};
use cloudtouch::Path;
use cloudtouch_cli::path_text;

pub(crate) fn read(file: &std::path::Path) -> Result<Path> {
    let named = || file.display().to_string();
    let text = std::fs::read_to_string(file)
        .with_context(|| format!("{}: cannot read the path", file.display()))?;
    let poses = path_text::parse(&text).with_context(named)?;
    Path::through(&poses).with_context(named)
}
