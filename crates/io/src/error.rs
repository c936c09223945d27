//! What can go wrong with a file: where in it, what was found, and what to do.
//!
//! The messages are complete in themselves (file, place, finding, remedy), so no error has a
//! further `source` that a reporter would print a second time.

use cloudtouch_geom::message::number;
use std::{
    io,
    path::{Path, PathBuf},
};

use crate::{
    conversion::remedy, fault::FormatError, missing::explained, recording_fault::RecordingFault,
};

/// Why a file could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system would not give its contents.
    #[error("{}: cannot be read: {cause}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        cause: io::Error,
    },
    /// It has more bytes than are read.
    #[error(
        "{}: has more than {limit} bytes, the most that is read: split or thin the file, or raise \
         the limit on bytes",
        path.display()
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Bytes read at most, [`ReadLimits::bytes`](crate::ReadLimits::bytes).
        limit: u64,
    },
    /// The extension is not one of a format that holds what was asked for.
    #[error(
        "{}: the extension {found:?} is not one of {supported}: {}",
        path.display(), remedy(found)
    )]
    Extension {
        /// The file.
        path: PathBuf,
        /// Its extension, empty when it has none.
        found: String,
        /// The extensions that would do.
        supported: &'static str,
    },
    /// The contents are not what the format demands.
    #[error("{}: {problem}", path.display())]
    Format {
        /// The file.
        path: PathBuf,
        /// Where and what.
        problem: Box<FormatError>,
    },
    /// It is a recording, which only a build with the feature `mcap` reads.
    #[error(
        "{}: is a recording, and this build reads none: build it with the feature `mcap`",
        path.display()
    )]
    NoRecordings {
        /// The recording.
        path: PathBuf,
    },
    /// It is a recording without the scan that was asked for.
    #[error("{}: {problem}", path.display())]
    Recording {
        /// The recording, or the name of the scan.
        path: PathBuf,
        /// Where in it and what.
        problem: Box<RecordingFault>,
    },
}

impl ReadError {
    /// Of a recording.
    pub(crate) fn recording(path: &Path, fault: RecordingFault) -> Self {
        Self::Recording { path: path.to_owned(), problem: Box::new(fault) }
    }

    /// Why a file could not be opened: what the operating system said, and more where the name tells it, as that of
    /// standard input does (`-`).
    #[must_use]
    pub fn of_opening(path: &Path, cause: io::Error) -> Self {
        Self::Io { path: path.to_owned(), cause: explained(path, cause) }
    }
}

/// Why a file could not be written. What stood under its name before is untouched.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The operating system would not take it.
    #[error("{}: cannot be written: {cause}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
        cause: io::Error,
    },
    /// Two lists that belong together differ in length.
    #[error(
        "{}: there are {found} {what} for {points} points: give one for each",
        path.display()
    )]
    Length {
        /// The file.
        path: PathBuf,
        /// What there is too much or too little of.
        what: &'static str,
        /// How many of them there are.
        found: usize,
        /// How many points there are.
        points: usize,
    },
    /// The sensor pose has a NaN or an infinity, which no reader would take back.
    #[error(
        "{}: the sensor pose has the entry {}: it must be finite",
        path.display(), number(*value)
    )]
    SensorPose {
        /// The file.
        path: PathBuf,
        /// What was found.
        value: f64,
    },
}
