//! Trees that change in place: primitives come, go and move.

mod insert;
pub(crate) mod patch;
mod refit;
mod remove;
