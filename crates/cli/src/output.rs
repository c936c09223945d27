//! Output files: no input is ever replaced, and nothing else without being asked.

use std::path::Path;

use anyhow::{Result, bail};
use cloudtouch_io::recording::file_of;

/// Whether files may be written: each is in a folder that is there, is none of the inputs and none of the
/// others, and not there unless `force` is given. `-` is no name of one. A pipe or a device may be.
pub(crate) fn check<'a>(
    outputs: &[&Path],
    inputs: impl Iterator<Item = &'a Path> + Clone,
    force: bool,
) -> Result<()> {
    for (number, output) in outputs.iter().enumerate() {
        let is_same =
            |other: &&Path| std::path::absolute(other).ok() == std::path::absolute(output).ok();
        if outputs[..number].iter().any(is_same) {
            bail!(
                "{}: is to be written twice: give each output a file of its own",
                output.display()
            );
        }
        check_one(output, inputs.clone(), force)?;
    }
    Ok(())
}

fn check_one<'a>(
    output: &Path,
    mut inputs: impl Iterator<Item = &'a Path>,
    force: bool,
) -> Result<()> {
    if output.as_os_str() == "-" {
        bail!(
            "-: would be a file of this name, not standard output, which has the answer without it: \
             name a file"
        );
    }
    let Ok(existing) = std::fs::canonicalize(output) else { return check_folder(output) };
    if existing.is_dir() {
        bail!("{}: cannot be written: is a folder: name a file in it", output.display());
    }
    // The input of a scan's name is the recording it is in.
    let is_input =
        |path: &Path| std::fs::canonicalize(file_of(path)).is_ok_and(|path| path == existing);
    if inputs.any(is_input) {
        bail!("{}: is an input of this very command: write to another file", output.display());
    }
    if existing.is_file() && !force {
        bail!("{}: is there already: give --force to replace it", output.display());
    }
    Ok(())
}

/// Told before the work is done that is to be written.
fn check_folder(output: &Path) -> Result<()> {
    let is_folder = output.as_os_str().as_encoded_bytes().ends_with(b"/");
    match if is_folder { Some(output) } else { output.parent() } {
        Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => bail!(
            "{}: cannot be written: there is no folder `{}`: make it first",
            output.display(),
            folder.display()
        ),
        _ => Ok(()),
    }
}
