//! The frames of scans of recordings: whether several are in one and at one time, and whether a sensor is at its origin.

use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use cloudtouch::noise::SensorModel;
use cloudtouch_io::recording::{RecordedScan, file_of};

/// Farther apart in time a sensor that moves is elsewhere, s; the scans of two sensors of a robot are at most so far.
const AT_ONCE: f64 = 0.1;

/// Refuses scans whose messages name different frames, for as one scene they would be laid on top of each other; and
/// warns where they were not taken at once, for their frame may have moved.
pub(super) fn check(scans: &[Taken]) -> Result<()> {
    let Some((first, others)) = scans.split_first() else { return Ok(()) };
    let mut apart = 0.0_f64;
    for other in others {
        ensure!(
            first.frame == other.frame || first.frame.is_empty() || other.frame.is_empty(),
            "{}: is in the frame {}, and {} in the frame {}: scans make one scene in one frame only; \
             make each a body of a scene file, with the pose of its frame, or transform them first",
            first.path.display(),
            first.frame,
            other.path.display(),
            other.frame
        );
        if !FIXED.contains(&first.own_frame()) {
            apart = apart.max(first.seconds_to(other));
        }
    }
    if apart > AT_ONCE {
        tracing::warn!(
            "{}: the other scans were taken up to {apart:.2} s before or after it, and all are taken to be in one \
             frame: that is so of a sensor that stood still; if it moved, make each a body of a scene file, with \
             its pose",
            first.path.display()
        );
    }
    Ok(())
}

/// Frames that by the conventions of ROS stand still.
const FIXED: [&str; 4] = ["map", "odom", "world", "earth"];
/// Others that are no sensor's, but a robot's.
const OF_ROBOTS: [&str; 2] = ["base_link", "base_footprint"];

/// Warns of scans in such a frame, where the noise goes by the place of the sensor, which nobody stated.
pub(super) fn warn_of_place(scans: &[Taken], sensor: &SensorModel) {
    if !sensor.is_camera() && !matches!(sensor, SensorModel::Lidar { .. }) {
        return;
    }
    for taken in scans {
        let own = taken.own_frame();
        if FIXED.contains(&own) || OF_ROBOTS.contains(&own) {
            tracing::warn!(
                "{}: is in the frame {}, and the sensor {sensor} is taken to have stood at its origin: give \
                 --sensor-pose (in a scene file `sensor_pose`), or noise that does not go by it, such as iso:0.02",
                taken.path.display(),
                taken.frame
            );
        }
    }
}

/// Where and when a scan was taken.
pub(crate) struct Taken {
    /// What names it: the recording, the topic and the time.
    path: PathBuf,
    /// From the beginning of the recording, s.
    time: f64,
    /// By the clock of the sensor, ns.
    stamp_ns: i64,
    /// The name of the frame; without the slash before it, as ROS 1 writes some.
    frame: String,
}

impl Taken {
    pub(super) fn of(path: &Path, found: &RecordedScan) -> Self {
        let frame = &found.scan.frame_id;
        let frame = frame.strip_prefix('/').unwrap_or(frame).to_owned();
        let (time, stamp_ns) = (found.time, found.scan.stamp_ns);
        Self { path: path.to_owned(), time, stamp_ns, frame }
    }

    /// The name without that of the robot: of several each has its own, `robot1/odom`.
    fn own_frame(&self) -> &str {
        self.frame.rsplit('/').next().unwrap_or_default()
    }

    /// By the clock of their recording, or of scans of two by their stamps, s.
    fn seconds_to(&self, other: &Self) -> f64 {
        if file_of(&self.path) == file_of(&other.path) {
            (self.time - other.time).abs()
        } else {
            self.stamp_ns.abs_diff(other.stamp_ns) as f64 / 1e9
        }
    }
}
