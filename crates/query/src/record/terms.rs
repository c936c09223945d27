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
    /// From this probability on nobody asks what speaks against a verdict.
    pub doubted_below: f64,
    /// Whether the two are all there is, and an object has to be near its scene and no larger: among many
    /// bodies most are far from most.
    pub are_alone: bool,
    pub max_contacts: usize,
    /// Which points the noisy-or counts.
    pub closeness: Closeness,
}
