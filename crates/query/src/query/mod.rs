//! The default path: geometry first, the classifier in doubt, a fitted probability.

mod any;
mod batch;
mod classify;
mod contacts;
mod estimate;
mod interval;
mod patches;
mod points;
mod run;
mod settings;
mod spots;
mod task;
mod uncertain;
mod within;

pub use any::NotFree;
pub use run::Query;
pub use settings::{Detail, QuerySettings};
pub use uncertain::{PoseDistribution, UnderPoses};
pub use within::Within;
