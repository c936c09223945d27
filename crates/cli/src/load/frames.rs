//! The frames of scans of recordings: whether several are in one and at one time, and whether a sensor is at its origin.

use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use cloudtouch::noise::SensorModel;
use cloudtouch_io::{
    ReadLimits, read_scan_within,
    recording::{ScanName, file_of},
};

/// Farther apart in time a sensor that moves is elsewhere, s; the scans of two sensors of a robot are at most so far.
const AT_ONCE: f64 = 0.1;

/// Refuses scans whose messages name different frames, for as one scene they would be laid on top of each other; and
/// warns where they were not taken at once, for their frame may have moved.
pub(super) fn check(paths: &[&Path], limits: &ReadLimits) -> Result<()> {
    let mut recorded = paths.iter().filter(|path| ScanName::of(path).is_some());
    let Some(first) = recorded.next() else { return Ok(()) };
    let (mut of_first, mut apart) = (None, 0.0_f64);
    for path in recorded {
        let wanted = match &of_first {
            None => of_first.insert(Taken::of(first, limits)?),
            Some(wanted) => wanted,
        };
        let found = Taken::of(path, limits)?;
        ensure!(
            wanted.frame == found.frame || wanted.frame.is_empty() || found.frame.is_empty(),
            "{}: is in the frame {}, and {} in the frame {}: scans make one scene in one frame only; \
             make each a body of a scene file, with the pose of its frame, or transform them first",
            first.display(),
            wanted.frame,
            path.display(),
            found.frame
        );
        if !FIXED.contains(&wanted.own_frame()) {
            apart = apart.max(wanted.seconds_to(&found));
        }
    }
    if apart > AT_ONCE {
        tracing::warn!(
            "{}: the other scans were taken up to {apart:.2} s before or after it, and all are taken to be in one \
             frame: that is so of a sensor that stood still; if it moved, make each a body of a scene file, with \
             its pose",
            first.display()
        );
    }
    Ok(())
}

/// Frames that by the conventions of ROS stand still.
const FIXED: [&str; 4] = ["map", "odom", "world", "earth"];
/// Others that are no sensor's, but a robot's.
const OF_ROBOTS: [&str; 2] = ["base_link", "base_footprint"];

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
        let taken = Taken::of(path, limits)?;
        let own = taken.own_frame();
        if FIXED.contains(&own) || OF_ROBOTS.contains(&own) {
            tracing::warn!(
                "{}: is in the frame {}, and the sensor {sensor} is taken to have stood at its origin: give \
                 --sensor-pose (in a scene file `sensor_pose`), or noise that does not go by it, such as iso:0.02",
                path.display(),
                taken.frame
            );
        }
    }
    Ok(())
}

/// Where and when a scan was taken.
struct Taken {
    /// The recording.
    file: PathBuf,
    /// From its beginning, s.
    time: f64,
    /// By the clock of the sensor, ns.
    stamp_ns: i64,
    /// The name of the frame; without the slash before it, as ROS 1 writes some.
    frame: String,
}

impl Taken {
    fn of(path: &Path, limits: &ReadLimits) -> Result<Self> {
        let found = read_scan_within(path, limits)?;
        let frame = found.scan.frame_id;
        let frame = frame.strip_prefix('/').unwrap_or(&frame).to_owned();
        Ok(Self { file: file_of(path), time: found.time, stamp_ns: found.scan.stamp_ns, frame })
    }

    /// The name without that of the robot: of several each has its own, `robot1/odom`.
    fn own_frame(&self) -> &str {
        self.frame.rsplit('/').next().unwrap_or_default()
    }

    /// By the clock of their recording, or of scans of two by their stamps, s.
    fn seconds_to(&self, other: &Self) -> f64 {
        if self.file == other.file {
            (self.time - other.time).abs()
        } else {
            self.stamp_ns.abs_diff(other.stamp_ns) as f64 / 1e9
        }
    }
}
