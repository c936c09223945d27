//! Queries: settings, the ladder for a leaf pair, and what becomes of its answer.

mod calibrated;
mod classify;
pub(crate) mod clock;
mod contacts;
mod estimate;
mod evidence;
mod leaf_pair;
mod leaf_pairs;
mod pool;
mod record;
mod run;
mod settings;
mod surface;
mod train;
mod unseen;

pub use calibrated::{ContactEvidence, Recalibration};
pub use run::Query;
pub use settings::{Mode, Pooling, QuerySettings};
