//! What a query has gathered, whichever path it goes, and the report made from it.

mod ask;
mod closeness;
mod estimate;
mod evidence;
mod point;

pub(crate) use ask::{CLEAR_DEVIATIONS, Terms};
pub use closeness::Closeness;
pub(crate) use estimate::{Estimate, Places};
pub(crate) use evidence::Evidence;
pub(crate) use point::{PointProbability, Side};
