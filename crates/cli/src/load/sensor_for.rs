//! `--sensor-for NAME=SPEC`: which files of a batch a NAME is of.

use std::path::Path;

use anyhow::{Result, bail};
use cloudtouch_cli::files::case::CaseFile;

use crate::sensor::SensorChoice;
use crate::usage::WrongUsage;

/// Of many files no more are named in a message.
const FILES_NAMED: usize = 5;

/// The options, for the files of a case file.
#[derive(Clone, Copy)]
pub(crate) struct SensorsFor<'a> {
    pub given: &'a [(String, SensorChoice)],
    pub cases: &'a Path,
}

impl SensorsFor<'_> {
    /// What is said of a file; the first NAME that it has counts.
    pub(crate) fn of(&self, file: &Path) -> Option<SensorChoice> {
        self.place(file).map(|place| self.given[place].1)
    }

    /// Which of the options counts for a file.
    pub(crate) fn place(&self, file: &Path) -> Option<usize> {
        self.given.iter().position(|(name, _)| self.has(file, name))
    }

    /// Refuses a NAME that no file has: it is misspelt, and its sensor would be of no cloud. A case that
    /// cannot be read may name the file.
    pub(crate) fn check(&self, file: &CaseFile) -> Result<()> {
        let mut paths = Vec::new();
        for (_, case) in &file.cases {
            let Ok(case) = case else { return Ok(()) };
            paths.extend([case.scene.as_path(), case.object.as_path()]);
        }
        paths.sort_unstable();
        paths.dedup();
        match self.given.iter().find(|(name, _)| !paths.iter().any(|path| self.has(path, name))) {
            Some((name, sensor)) => bail!(WrongUsage(format!(
                "--sensor-for {name}={sensor}: no file of {} has `{name}` in its path: correct it to \
                 part of {}",
                self.cases.display(),
                self.listed(&paths)
            ))),
            None => Ok(()),
        }
    }

    /// Refuses a NAME that only meshes have. `files` are all, each with whether it is a mesh.
    pub(crate) fn check_meshes(&self, files: &[(&Path, bool)]) -> Result<()> {
        let of_meshes = |name: &str| {
            let mut found = files.iter().filter(|(path, _)| self.has(path, name)).peekable();
            found.peek().is_some() && found.all(|(_, is_mesh)| *is_mesh)
        };
        match self.given.iter().find(|(name, _)| of_meshes(name)) {
            Some((name, sensor)) => bail!(WrongUsage(format!(
                "--sensor-for {name}={sensor} is for clouds, and all files with `{name}` in their path \
                 are meshes: leave it out"
            ))),
            None => Ok(()),
        }
    }

    fn has(&self, file: &Path, name: &str) -> bool {
        self.written(file).to_string_lossy().contains(name)
    }

    /// As the case file has it: the folder that this lies in would make all files alike.
    fn written<'p>(&self, file: &'p Path) -> &'p Path {
        let folder = self.cases.parent().unwrap_or(Path::new(""));
        file.strip_prefix(folder).unwrap_or(file)
    }

    fn listed(&self, paths: &[&Path]) -> String {
        let named = paths.iter().take(FILES_NAMED).map(|path| self.written(path).display());
        let named = named.map(|path| path.to_string()).collect::<Vec<_>>().join(", ");
        match paths.len().saturating_sub(FILES_NAMED) {
            0 => named,
            more => format!("{named} or {more} more"),
        }
    }
}
