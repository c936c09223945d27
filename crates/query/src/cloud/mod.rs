//! Noisy clouds prepared for queries: filtered, indexed, in a tree; the costly part of the noise
//! model is computed for a leaf when a query first visits it.

mod accessors;
mod around;
mod change;
mod inside;
mod local;
mod makeup;
mod overlap;
mod pieces;
mod preparation;
mod prepare;
mod prepared;
mod primitives;
mod scans;
mod settings;
mod sight;
mod surface;
mod view;

pub(crate) use accessors::cloud_accessors;
pub use change::Change;
pub(crate) use inside::points_inside;
pub(crate) use makeup::clumps::Clumps;
pub(crate) use makeup::scatter::Overstated;
pub(crate) use makeup::{Makeup, SensorDoubt};
pub(crate) use preparation::Preparation;
pub use prepare::Cloud;
pub(crate) use prepared::Prepared;
pub use settings::CloudSettings;
pub(crate) use surface::ball::Ball;
pub(crate) use surface::edge::{DISC_SPACINGS, EDGE_SLOPE, Edge, MOST_ALONG, edge_along};
pub(crate) use surface::edges::{LeafEdges, Pieces};
#[cfg(test)]
pub(crate) use surface::join::edges_of;
pub(crate) use surface::leaf::LeafSurface;
pub(crate) use surface::onward::Onward;
pub(crate) use surface::slab::Slab;
pub(crate) use surface::surfel::{End, Surfel};
pub(crate) use view::seen::Sight;
