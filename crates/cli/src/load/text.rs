//! Small files of text.

use std::path::Path;

use anyhow::{Context as _, Result, ensure};

/// The text of a file of poses, `what` it is for.
pub(super) fn read(path: &Path, what: &str) -> Result<String> {
    let named = || format!("{}: cannot read the {what}", path.display());
    ensure!(!path.is_dir(), "{}: is a folder: give the file of the {what}", path.display());
    let bytes = std::fs::read(path).with_context(named)?;
    let no_text = "it is no text (UTF-8): write its numbers as text, such as with numpy.savetxt";
    String::from_utf8(bytes).ok().context(no_text).with_context(named)
}
