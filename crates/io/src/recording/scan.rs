//! A scan with where in a recording it was.

use crate::pointcloud2::Scan;

/// A scan out of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedScan {
    /// What the message holds.
    pub scan: Scan,
    /// The topic it came on.
    pub topic: String,
    /// When it was recorded, s from the beginning of the recording.
    pub time: f64,
}
