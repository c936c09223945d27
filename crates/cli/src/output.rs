//! Output files: no input is ever replaced, and nothing else without being asked.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use cloudtouch_io::recording::file_of;

use crate::usage::WrongUsage;

/// A file that an option names.
pub(crate) struct Output<'a> {
    path: &'a Path,
    /// What other programs know its format by; a table may have any.
    extension: Option<&'static str>,
}

impl<'a> Output<'a> {
    /// A picture or page, if it is asked for.
    pub(crate) fn of(extension: &'static str, path: &'a Option<PathBuf>) -> Option<Self> {
        Some(Self { path: path.as_deref()?, extension: Some(extension) })
    }

    /// A table, if it is asked for.
    pub(crate) fn table(path: &'a Option<PathBuf>) -> Option<Self> {
        Some(Self { path: path.as_deref()?, extension: None })
    }
}

/// Whether files may be written: each is in a folder that is there, is none of the inputs and none of the
/// others, has no extension of another format, and is not there unless `force` is given. `-` is no name
/// of one. A pipe or a device may be.
pub(crate) fn check<'a>(
    outputs: &[Option<Output<'_>>],
    inputs: impl Iterator<Item = &'a Path> + Clone,
    force: bool,
) -> Result<()> {
    let outputs: Vec<&Output<'_>> = outputs.iter().flatten().collect();
    for (number, output) in outputs.iter().enumerate() {
        if outputs[..number].iter().any(|other| place(other.path) == place(output.path)) {
            bail!(
                "{}: is to be written twice: give each output a file of its own",
                output.path.display()
            );
        }
        check_one(output, inputs.clone(), force)?;
    }
    Ok(())
}

/// Where a file is or will be, by whatever folders or links it is named.
fn place(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let new = || {
        let folder = std::fs::canonicalize(folder.unwrap_or(Path::new("."))).ok()?;
        Some(folder.join(path.file_name()?))
    };
    std::fs::canonicalize(path).ok().or_else(new).or_else(|| std::path::absolute(path).ok())
}

fn check_one<'a>(
    &Output { path: output, extension }: &Output<'_>,
    mut inputs: impl Iterator<Item = &'a Path>,
    force: bool,
) -> Result<()> {
    if output.as_os_str() == "-" {
        bail!(
            "-: would be a file of this name, not standard output, which has the answer without it: \
             name a file"
        );
    }
    let Ok(existing) = std::fs::canonicalize(output) else {
        check_folder(output)?;
        return check_extension(output, extension);
    };
    if existing.is_dir() {
        bail!("{}: cannot be written: is a folder: name a file in it", output.display());
    }
    // The input of a scan's name is the recording it is in.
    let is_input =
        |path: &Path| std::fs::canonicalize(file_of(path)).is_ok_and(|path| path == existing);
    if inputs.any(is_input) {
        bail!("{}: is an input of this very command: write to another file", output.display());
    }
    check_extension(output, extension)?;
    if existing.is_file() && !force {
        bail!("{}: is there already: give --force to replace it", output.display());
    }
    Ok(())
}

/// A name that promises another format; one without an extension promises none.
fn check_extension(output: &Path, wanted: Option<&str>) -> Result<()> {
    match (output.extension(), wanted) {
        (Some(given), Some(wanted)) if !given.eq_ignore_ascii_case(wanted) => {
            bail!(WrongUsage(format!(
                "{}: is written as {}: name it {}",
                output.display(),
                wanted.to_uppercase(),
                output.with_extension(wanted).display()
            )))
        }
        _ => Ok(()),
    }
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
