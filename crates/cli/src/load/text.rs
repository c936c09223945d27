//! Small files of text.

use std::path::Path;

use anyhow::{Context as _, Result, ensure};
use cloudtouch_io::{ReadError, read_bytes};

/// The text of a file of at most so many bytes, `what` it is for.
pub(crate) fn read(path: &Path, what: &str, max_bytes: u64) -> Result<String> {
    let named = || format!("{}: cannot read the {what}", path.display());
    ensure!(!path.is_dir(), "{}: is a folder: give the file of the {what}", path.display());
    let bytes = match read_bytes(path, max_bytes) {
        Err(ReadError::Io { cause, .. }) => Err(cause).with_context(named)?,
        read => read?,
    };
    let no_text = "it is no text (UTF-8): write its numbers as text, such as with numpy.savetxt";
    String::from_utf8(bytes).ok().context(no_text).with_context(named)
}
