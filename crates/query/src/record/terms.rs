//! By what a path turns what it gathered into a report.

use crate::doubt::safeguards::Safeguards;
use crate::mode::Mode;

use super::closeness::Closeness;

/// By what a path turns what it gathered into a report.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Terms {
    pub mode: Mode,
    pub seed: u64,
    pub accept: f64,
    pub reject: f64,
    pub safeguards: Safeguards,
    /// Whether a body may be too far away to be meant: not where there are many, most far from most.
    pub doubts_distance: bool,
    pub max_contacts: usize,
    /// Which points the noisy-or counts.
    pub closeness: Closeness,
}
