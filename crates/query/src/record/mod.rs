//! What a query has gathered, whichever path it goes, and the report made from it.

mod ask;
mod closeness;
mod doubt;
mod estimate;
mod evidence;
mod point;
pub(crate) mod pool;
mod terms;
mod verdict;

pub use closeness::Closeness;
pub(crate) use doubt::CLEAR_DEVIATIONS;
pub(crate) use estimate::{Estimate, Places};
pub(crate) use evidence::Evidence;
pub(crate) use point::{PointProbability, Side};
pub(crate) use terms::Terms;
