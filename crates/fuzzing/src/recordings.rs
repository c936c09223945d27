//! Recordings: any bytes have topics whose scans they back, or an error that names the file.

use std::cell::OnceCell;
use std::path::Path;

use cloudtouch_io::recording::Recording;
use cloudtouch_io::{ReadError, ReadLimits};
use tempfile::NamedTempFile;

use crate::readers::{LONGEST_MESSAGE, check_cloud};

/// Points of a scan.
const MOST_POINTS: usize = 1 << 16;
/// A chunk may hold so many bytes, unpacked.
const LIMITS: ReadLimits = ReadLimits { bytes: 1 << 20, points: MOST_POINTS, triangles: 0 };

thread_local! {
    /// A recording is read from a file, for it may be larger than memory.
    static FILE: OnceCell<NamedTempFile> = const { OnceCell::new() };
}

/// Bytes as an MCAP recording: what is listed of it, and the first scan of each topic and one later.
///
/// # Panics
/// When a scan has more points than the limits allow, a topic that is listed has no scan and no good
/// reason, or the file cannot be written.
pub fn read_mcap(bytes: &[u8]) {
    FILE.with(|file| {
        let file = file.get_or_init(|| NamedTempFile::new().expect("a temporary file"));
        std::fs::write(file.path(), bytes).expect("a temporary file that can be written");
        if let Err(error) = read(file.path()) {
            let message = error.to_string();
            let name = file.path().display().to_string();
            assert!(message.starts_with(&name), "no file in: {message}");
            assert!(message.len() < name.len() + LONGEST_MESSAGE, "{} bytes", message.len());
        }
    });
}

fn read(path: &Path) -> Result<(), ReadError> {
    let mut recording = Recording::open(path, &LIMITS)?;
    for topic in recording.topics()? {
        assert!(topic.messages > 0 && topic.first <= topic.last, "{topic:?}");
        for at in [topic.first, 0.5 * (topic.first + topic.last)] {
            let scan = recording.scan(Some(&topic.name), Some(at))?;
            check_cloud(&scan.scan.cloud, MOST_POINTS);
        }
    }
    recording.scan(None, None).map(|_| ())
}
