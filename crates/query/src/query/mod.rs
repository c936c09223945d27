//! The default path: geometry first, the classifier in doubt, a fitted probability.

mod any;
mod batch;
mod blur;
mod classify;
mod contacts;
mod directions;
mod estimate;
mod gap_by_pose;
mod gradient;
mod interval;
mod nearing;
mod parting;
mod patches;
mod penetration;
mod points;
mod run;
mod settings;
mod spots;
mod task;
mod uncertain;
mod weigh;
mod within;

pub use any::NotFree;
pub(crate) use blur::noise_over_spacing;
pub use gradient::PoseGradient;
pub use penetration::Penetration;
pub use run::Query;
pub use settings::{Detail, QuerySettings};
pub use uncertain::{PoseDistribution, UnderPoses};
pub use within::Within;
