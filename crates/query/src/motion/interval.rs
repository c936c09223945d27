//! Stretches of a path that wait to be looked at closer.

use std::cmp::Ordering;

/// A stretch of one segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Interval {
    pub segment: usize,
    /// Times within the segment.
    pub times: [f64; 2],
    /// No pose of it is more probable.
    pub upper: f64,
    /// The upper bound was not looked for beyond this: 1 stands for more.
    pub cut: f64,
    /// Whether something speaks against believing that all of it is free.
    pub is_doubtful: bool,
}

impl Interval {
    /// A whole segment that was not looked at.
    pub(super) fn unknown(segment: usize) -> Self {
        Self { segment, times: [0.0, 1.0], upper: 1.0, cut: 1.0, is_doubtful: false }
    }

    pub(super) fn length(&self) -> f64 {
        self.times[1] - self.times[0]
    }

    pub(super) fn middle(&self) -> f64 {
        0.5 * (self.times[0] + self.times[1])
    }

    /// Where it begins, in segments from the beginning of the path.
    pub(super) fn start(&self) -> f64 {
        self.segment as f64 + self.times[0]
    }

    pub(super) fn end(&self) -> f64 {
        self.segment as f64 + self.times[1]
    }
}

impl Eq for Interval {}

/// The greatest is looked at first: the least certain, of these the longest, then the earliest.
impl Ord for Interval {
    fn cmp(&self, other: &Self) -> Ordering {
        (self.upper.total_cmp(&other.upper))
            .then(self.length().total_cmp(&other.length()))
            .then(other.start().total_cmp(&self.start()))
    }
}

impl PartialOrd for Interval {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
