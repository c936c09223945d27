//! The default path: geometry first, the classifier in doubt, a fitted probability.

mod any;
mod around;
mod batch;
mod blur;
mod classify;
mod estimate;
mod interval;
mod misclassified;
mod narrowing;
mod patches;
mod places;
mod poses;
mod run;
mod settings;
mod steering;
mod task;
mod weigh;
mod within;

pub use any::NotFree;
pub(crate) use blur::blur;
pub use poses::gradient::PoseGradient;
pub use poses::penetration::Penetration;
pub use poses::uncertain::{PoseDistribution, UnderPoses};
pub use run::Query;
pub use settings::{Detail, QuerySettings};
pub use within::Within;
