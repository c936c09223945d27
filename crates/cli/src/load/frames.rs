//! The frames of scans of recordings: whether several are in one, and whether a sensor is at its origin.

use std::path::Path;

use anyhow::{Result, ensure};
use cloudtouch::noise::SensorModel;
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

/// Frames that by the conventions of ROS are no sensor's.
const NO_SENSORS: [&str; 6] = ["map", "odom", "world", "earth", "base_link", "base_footprint"];

/// Warns of scans in such a frame, where the noise goes by the place of the sensor, which nobody stated.
pub(super) fn warn_of_place(
    paths: &[&Path],
    sensor: &SensorModel,
    limits: &ReadLimits,
) -> Result<()> {
    if !sensor.is_camera() && !matches!(sensor, SensorModel::Lidar { .. }) {
        return Ok(());
    }
    for path in paths.iter().filter(|path| ScanName::of(path).is_some()) {
        let frame = frame(path, limits)?;
        // Of several robots each has its own: `robot1/odom`.
        let own = frame.rsplit('/').next().unwrap_or_default();
        if NO_SENSORS.contains(&own) {
            tracing::warn!(
                "{}: is in the frame {frame}, and the sensor {sensor} is taken to have stood at its origin: give \
                 --sensor-pose (in a scene file `sensor_pose`), or noise that does not go by it, such as iso:0.02",
                path.display()
            );
        }
    }
    Ok(())
}

/// Its name; ROS 1 writes some with a slash.
fn frame(path: &Path, limits: &ReadLimits) -> Result<String> {
    let frame = read_scan_within(path, limits)?.scan.frame_id;
    Ok(frame.strip_prefix('/').unwrap_or(&frame).to_owned())
}
