//! How accurate collision probabilities are, measured against exact truth.

#[allow(dead_code, unused_imports, reason = "the sweep that asks them is not a task yet")]
pub(crate) mod rivals;
