//! The two ways of estimating a probability.

use serde::Serialize;

/// Which of the two ways of estimating a probability is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// Surface posteriors, certified traversal, and the most favourable of the separating
    /// surfaces tried.
    #[default]
    Calibrated,
    /// As printed in the paper: precisions added, stochastic traversal, the kernel classifier.
    Paper,
}
