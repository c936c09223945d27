//! Output files: no input is ever replaced, and nothing else without being asked.

use std::path::Path;

use anyhow::{Result, bail};
use cloudtouch_io::recording::file_of;

/// Whether a file may be written: it is none of the inputs, and not there unless `force` is given. A
/// pipe or a device may be.
pub(crate) fn check<'a>(
    output: &Path,
    inputs: impl IntoIterator<Item = &'a Path>,
    force: bool,
) -> Result<()> {
    let Ok(existing) = std::fs::canonicalize(output) else { return Ok(()) };
    // The input of a scan's name is the recording it is in.
    let is_input =
        |path: &Path| std::fs::canonicalize(file_of(path)).is_ok_and(|path| path == existing);
    if inputs.into_iter().any(is_input) {
        bail!("{}: is an input of this very command: write to another file", output.display());
    }
    if existing.is_file() && !force {
        bail!("{}: is there already: give --force to replace it", output.display());
    }
    Ok(())
}
