//! Noisy clouds prepared for queries: filtered, indexed, in a tree; the costly part of the noise
//! model is computed for a leaf when a query first visits it.

mod accessors;
mod around;
mod ball;
mod carry;
mod change;
mod clumps;
mod edge;
mod frame;
mod inside;
mod join;
mod lazy;
mod leaf;
mod lost;
mod makeup;
mod onward;
mod overlap;
mod patch;
mod pieces;
mod pinhole;
mod preparation;
mod prepare;
mod prepared;
mod raster;
mod refine;
mod regrow;
mod scans;
mod scatter;
mod settings;
mod slab;
mod slots;
mod spread;
mod surfel;
mod view;

pub(crate) use accessors::cloud_accessors;
pub(crate) use ball::Ball;
pub use change::Change;
pub(crate) use clumps::Clumps;
pub(crate) use edge::{DISC_SPACINGS, Edge, MOST_ALONG, edge_along};
pub(crate) use inside::points_inside;
#[cfg(test)]
pub(crate) use join::edges_of;
pub(crate) use leaf::{LeafEdges, LeafSurface};
pub(crate) use makeup::{Makeup, SensorDoubt};
pub(crate) use onward::Onward;
pub(crate) use preparation::Preparation;
pub use prepare::Cloud;
pub(crate) use prepared::Prepared;
pub(crate) use raster::Sight;
pub(crate) use scatter::Overstated;
pub use settings::CloudSettings;
pub(crate) use slab::Slab;
pub(crate) use surfel::Surfel;
