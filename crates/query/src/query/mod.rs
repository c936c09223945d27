//! The default path: geometry first, the classifier in doubt, a fitted probability.

mod batch;
mod calibrated;
mod classify;
mod exact;
mod leaf_pairs;
mod run;
mod settings;
mod signed;
mod task;

pub(crate) use exact::{ExactPair, exact_pair};
pub use run::Query;
pub use settings::QuerySettings;
