//! Whether several scans of recordings are in one frame.

use std::path::Path;

use anyhow::{Result, ensure};
use cloudtouch_io::{ReadLimits, read_scan_within, recording::ScanName};

/// Refuses scans whose messages name different frames: as one scene they would be laid on top of each other.
pub(super) fn check(paths: &[&Path], limits: &ReadLimits) -> Result<()> {
    let mut recorded = paths.iter().filter(|path| ScanName::of(path).is_some());
    let Some(first) = recorded.next() else { return Ok(()) };
    let mut of_first = None;
    for path in recorded {
        let wanted = match &of_first {
            None => of_first.insert(frame(first, limits)?),
            Some(wanted) => wanted,
        };
        let found = frame(path, limits)?;
        ensure!(
            *wanted == found || wanted.is_empty() || found.is_empty(),
            "{}: is in the frame {wanted}, and {} in the frame {found}: scans make one scene in one frame only; \
             make each a body of a scene file, with the pose of its frame, or transform them first",
            first.display(),
            path.display()
        );
    }
    Ok(())
}

/// Its name; ROS 1 writes some with a slash.
fn frame(path: &Path, limits: &ReadLimits) -> Result<String> {
    let frame = read_scan_within(path, limits)?.scan.frame_id;
    Ok(frame.strip_prefix('/').unwrap_or(&frame).to_owned())
}
