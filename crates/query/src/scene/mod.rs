//! Many bodies, each with its own pose: which of them may touch.

mod allowed;
mod answer;
mod attached;
mod bodies;
mod broad;
mod check;
mod near;
mod stray;

pub use answer::{BodyWarning, Checked, Outside, PairAnswer};
pub use bodies::Scene;
