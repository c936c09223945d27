//! A path in a file.

use anyhow::{Context, Result};
use cloudtouch::Path;
use cloudtouch_cli::files::path::{self, PathText};

use super::text;
use crate::doubt::Doubt;

/// The poses of a file, each joined to the next by a screw or by a straight way and slerp; and what is
/// to be doubted of them, which has been warned of.
pub(crate) fn read(
    file: &std::path::Path,
    is_screw: bool,
    max_bytes: u64,
) -> Result<(Path, Option<Doubt>)> {
    let named = || file.display().to_string();
    let text = text::read(file, "path", max_bytes)?;
    let PathText { poses, unnamed } = path::parse(&text).with_context(named)?;
    let doubt = unnamed.as_ref().map(Doubt::of_unnamed);
    if let Some(doubt) = &doubt {
        tracing::warn!("{}: {}", file.display(), doubt.words);
    }
    let path = if is_screw { Path::through_by_screws(&poses) } else { Path::through(&poses) };
    Ok((path.with_context(named)?, doubt))
}
