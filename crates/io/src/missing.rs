//! A file that is not there by a name that means something to other programs.

use std::{
    io::{
        self,
        ErrorKind::{InvalidFilename, NotFound},
    },
    path::Path,
};

/// What the operating system said, and what the name tells beside it.
pub(crate) fn explained(path: &Path, cause: io::Error) -> io::Error {
    let name = path.to_string_lossy();
    let why = match &*name {
        // Some systems have no such names.
        _ if !matches!(cause.kind(), NotFound | InvalidFilename) => return cause,
        "-" => "standard input is not read: give the name of a file",
        home if home.starts_with("~/") => {
            "only a shell takes `~` for a home folder, outside of quotes: write the whole path"
        }
        address if address.contains("://") => "addresses are not read: give the path of a file",
        written if written.starts_with(['{', '[']) => {
            "it is what a file would hold: write it to one, and give its name"
        }
        _ => return cause,
    };
    io::Error::new(cause.kind(), format!("{cause}; {why}"))
}
