//! How a scan in a recording is named where a file is asked for.

use std::path::{Path, PathBuf};

use crate::recording_fault::RecordingFault;
use crate::{error::ReadError, text::excerpt};

/// A scan in a recording: `run.mcap#/topic@SECONDS`.
#[derive(Debug, Clone, PartialEq)]
pub struct ScanName {
    /// The recording.
    pub file: PathBuf,
    /// The topic; without one, the only topic that has scans.
    pub topic: Option<String>,
    /// The first message at or after this time counts, s from the beginning of the recording, 0 or
    /// more; without one, the first of all.
    pub at: Option<f64>,
}

impl ScanName {
    /// The scan that a path names; `None` when it is the path of no recording.
    ///
    /// A recording is what ends in `.mcap`, in any case, and a scan of it what goes on with `#`. The last `@`
    /// begins the time: a topic that has one in its name is asked for with a time.
    ///
    /// # Errors
    /// When what follows the last `@` is no time.
    pub fn of(path: &Path) -> Option<Result<Self, ReadError>> {
        let (file, rest) = split(path)?;
        let (topic, at) = match rest.map(|rest| rest.rsplit_once('@').unwrap_or((rest, ""))) {
            Some((topic, at)) => (Some(topic).filter(|t| !t.is_empty()), at),
            None => (None, ""),
        };
        let topic = topic.map(str::to_owned);
        if at.is_empty() && !rest.is_some_and(|rest| rest.ends_with('@')) {
            return Some(Ok(Self { file, topic, at: None }));
        }
        Some(match at.parse::<f64>() {
            Ok(seconds) if seconds.is_finite() && seconds >= 0.0 => {
                Ok(Self { file, topic, at: Some(seconds) })
            }
            _ => {
                let found = excerpt(at.as_bytes());
                Err(ReadError::recording(path, RecordingFault::Time { found }))
            }
        })
    }
}

/// The file on the disk that a path is about: that of the recording for the name of a scan.
///
/// ```
/// use cloudtouch_io::recording::file_of;
/// use std::path::Path;
///
/// assert_eq!(file_of(Path::new("a/run.mcap#/points@1.5")), Path::new("a/run.mcap"));
/// assert_eq!(file_of(Path::new("a/scan#2.pcd")), Path::new("a/scan#2.pcd"));
/// ```
pub fn file_of(path: &Path) -> PathBuf {
    split(path).map_or_else(|| path.to_owned(), |(file, _)| file)
}

const EXTENSION: &str = ".mcap";

/// The recording, and what follows the `#`.
fn split(path: &Path) -> Option<(PathBuf, Option<&str>)> {
    let Some(text) = path.to_str() else {
        let is_recording = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("mcap"));
        return is_recording.then(|| (path.to_owned(), None));
    };
    // Of the same length, so that places in one are places in the other.
    let lower = text.to_ascii_lowercase();
    match lower.find(&format!("{EXTENSION}#")) {
        Some(at) => {
            let (file, rest) = text.split_at(at + EXTENSION.len());
            Some((file.into(), Some(&rest[1..])))
        }
        None => lower.ends_with(EXTENSION).then(|| (path.to_owned(), None)),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]
mod tests {
    use super::*;

    #[test]
    fn names_have_a_file_a_topic_and_a_time() {
        for (path, file, topic, at) in [
            ("run.mcap", "run.mcap", None, None),
            ("a#b/Run.MCAP", "a#b/Run.MCAP", None, None),
            ("run.mcap#/points", "run.mcap", Some("/points"), None),
            ("run.mcap#/a.pcd@1.5", "run.mcap", Some("/a.pcd"), Some(1.5)),
            ("run.mcap#@0", "run.mcap", None, Some(0.0)),
            ("run.mcap#", "run.mcap", None, None),
            ("run.mcap#plain@2e1", "run.mcap", Some("plain"), Some(20.0)),
            ("run.mcap#/a.mcap", "run.mcap", Some("/a.mcap"), None),
        ] {
            let name = ScanName::of(Path::new(path)).unwrap().unwrap();
            let expected = ScanName { file: file.into(), topic: topic.map(str::to_owned), at };
            assert_eq!(name, expected, "{path}");
            assert_eq!(file_of(Path::new(path)), Path::new(file));
        }
        for path in ["scan.pcd", "scan#1.pcd", "mcap", "run.mcap.pcd", ""] {
            assert!(ScanName::of(Path::new(path)).is_none(), "{path}");
        }
    }

    #[test]
    fn the_time_of_a_topic_with_an_at_sign_was_looked_for_in_its_name() {
        let name = ScanName::of(Path::new("run.mcap#/left@front@2.5")).unwrap().unwrap();
        assert_eq!((name.topic.as_deref(), name.at), (Some("/left@front"), Some(2.5)));
    }

    #[test]
    fn a_time_is_a_number_from_zero() {
        for time in ["", "-1", "nan", "inf", "1s", "1@b"] {
            let path = format!("run.mcap#/a@{time}");
            let error = ScanName::of(Path::new(&path)).unwrap().unwrap_err().to_string();
            assert!(error.starts_with(&path) && error.contains("is no time"), "{error}");
        }
    }
}
