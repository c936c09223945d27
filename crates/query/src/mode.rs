//! The two paths by name.

use serde::Serialize;

/// Which of the two paths made a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// The default, [`Query`](crate::Query): surface posteriors, certified traversal, a probability
    /// fitted to scenes whose truth is known.
    #[default]
    Calibrated,
    /// As printed in the paper, [`PaperQuery`](crate::PaperQuery): precisions added, stochastic
    /// traversal, the kernel classifier.
    Paper,
}
