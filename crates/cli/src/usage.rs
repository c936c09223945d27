//! Wrong usage that shows only once the files are read.

use std::fmt;

/// An option that the files given have no use for: an error with the exit code of wrong usage.
#[derive(Debug)]
pub(crate) struct WrongUsage(pub String);

impl fmt::Display for WrongUsage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for WrongUsage {}

/// As the command line's own parser gives it.
pub(crate) const EXIT_CODE: u8 = 2;

/// What is wrong with a sensor that a file gives a mesh.
pub(crate) fn of_a_mesh(field: &str, file: &str) -> String {
    format!("`{field}` is of a cloud, and {file} is a mesh, which has no sensor: leave it out")
}
