//! What can go wrong with a recording.

use std::fmt;

use crate::{fault::FormatError, text::excerpt};

/// Why a scan could not be taken out of a recording.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingFault {
    /// What follows the `#` of a name is no topic and time.
    #[error("{found:?} is no time: write run.mcap#/topic@SECONDS, seconds from the beginning")]
    Time {
        /// What stands where the seconds should.
        found: String,
    },
    /// It does not begin as an MCAP file does.
    #[error("is no MCAP recording: is the file extension right?")]
    Magic,
    /// It does not end as an MCAP file does, or does not say what is where in it.
    #[error("{reason}: mend it with `mcap recover FILE -o WHOLE.mcap`")]
    NoIndex {
        /// What is missing.
        reason: &'static str,
    },
    /// Something in it contradicts itself.
    #[error(
        "byte {byte}: {reason}: the recording is damaged, try `mcap recover FILE -o WHOLE.mcap`"
    )]
    Damaged {
        /// Where the part begins that is damaged.
        byte: u64,
        /// What is wrong with it.
        reason: String,
    },
    /// A part of it is larger than the limit on bytes.
    #[error(
        "byte {byte}: {what} takes {found} bytes, and at most {limit} are read: record with \
         smaller chunks, or raise the limit on bytes"
    )]
    TooLarge {
        /// Where it begins.
        byte: u64,
        /// Which part.
        what: &'static str,
        /// How many bytes it takes.
        found: u64,
        /// How many are read, [`ReadLimits::bytes`](crate::ReadLimits::bytes).
        limit: u64,
    },
    /// No topic has scans.
    #[error("no topic holds sensor_msgs/PointCloud2: record one, or give another file")]
    NoClouds,
    /// The name has no topic, and there are several.
    #[error("several topics hold PointCloud2: name one of {topics}, as in run.mcap#/topic@SECONDS")]
    SeveralTopics {
        /// Those that do.
        topics: Names,
    },
    /// The topic named is not there.
    #[error("there is no topic {topic}: PointCloud2 is on {topics}")]
    UnknownTopic {
        /// The one named.
        topic: String,
        /// Those that have scans.
        topics: Names,
    },
    /// The topic named has no scans.
    #[error("topic {topic} holds {found}, not sensor_msgs/PointCloud2, which is on {topics}")]
    OtherType {
        /// The one named.
        topic: String,
        /// The type of its messages.
        found: String,
        /// Those that have scans.
        topics: Names,
    },
    /// The messages are written in a way that is not read.
    #[error("topic {topic} is encoded as {found:?}, expected \"cdr\" (ROS 2) or \"ros1\"")]
    Encoding {
        /// The topic named.
        topic: String,
        /// How it is encoded.
        found: String,
    },
    /// The topic has no message so late.
    #[error(
        "topic {topic} has no message at or after {at} s from the beginning, its last is at \
         {last} s: give an earlier time"
    )]
    TooLate {
        /// The topic named.
        topic: String,
        /// The time asked for, s from the beginning.
        at: f64,
        /// When its last message came, s from the beginning.
        last: f64,
    },
    /// A message is no scan.
    #[error("topic {topic} at {time} s from the beginning: {problem}")]
    Message {
        /// The topic named.
        topic: String,
        /// When the message came, s from the beginning.
        time: f64,
        /// Where in the message, and what.
        problem: FormatError,
    },
}

/// Names of topics, of which a message shows the first few.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Names(pub Vec<String>);

impl fmt::Display for Names {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 6;
        let shown: Vec<String> =
            self.0.iter().take(SHOWN).map(|name| excerpt(name.as_bytes())).collect();
        match self.0.len() {
            0 => f.write_str("no topic"),
            all if all > SHOWN => write!(f, "{} and {} more", shown.join(", "), all - SHOWN),
            _ => f.write_str(&shown.join(", ")),
        }
    }
}
