//! A path in a file.

use anyhow::{Context, Result};
use cloudtouch::Path;
use cloudtouch_cli::path_text::{self, PathText};

/// The poses of a file, each joined to the next by a screw or by a straight way and slerp.
pub(crate) fn read(file: &std::path::Path, is_screw: bool) -> Result<Path> {
    let named = || file.display().to_string();
    let text = std::fs::read_to_string(file)
        .with_context(|| format!("{}: cannot read the path", file.display()))?;
    let PathText { poses, half_turns } = path_text::parse(&text).with_context(named)?;
    if let Some((line, row)) = half_turns {
        tracing::warn!(
            "{}: line {line}: `{row}` and all other rows are a half turn about z: without a header the \
             columns are read as x,y,z,qw,qx,qy,qz; if w is last, begin the file with the line \
             x,y,z,qx,qy,qz,qw",
            file.display()
        );
    }
    let path = if is_screw { Path::through_by_screws(&poses) } else { Path::through(&poses) };
    path.with_context(named)
}
