//! Queries: settings, the ladder for a leaf pair, and what becomes of its answer.

mod calibrated;
mod classify;
mod clock;
mod contacts;
mod estimate;
mod evidence;
mod exact;
mod leaf_pair;
mod leaf_pairs;
mod pair;
mod pool;
mod record;
mod run;
mod settings;
mod signed;
mod surface;
mod task;
mod train;
mod unseen;

pub use run::Query;
pub use settings::{Pooling, QuerySettings};
