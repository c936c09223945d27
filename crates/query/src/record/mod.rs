//! What a query has gathered, whichever path it goes, and the report made from it.

mod add;
mod ask;
mod estimate;
mod evidence;
mod point;
mod signed;

pub(crate) use add::{CORRELATION_SPACINGS, add_exact, add_pair};
pub(crate) use ask::Terms;
pub(crate) use estimate::{Estimate, Places};
pub(crate) use evidence::Evidence;
pub(crate) use point::{PointProbability, Side};
pub(crate) use signed::{SignedPoint, add_signed_points};
