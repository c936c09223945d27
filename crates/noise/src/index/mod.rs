//! Which positions of a cloud are where: a k-d tree, and an octree for many neighbours at once.

pub(crate) mod block;
pub(crate) mod density;
mod entries;
mod held;
mod morton;
pub(crate) mod neighbor;
mod octree;
mod overlay;
pub(crate) mod places;
pub(crate) mod positions;
mod sorted;
pub(crate) mod spacing;
pub(crate) mod spatial_order;
pub(crate) mod thinned;
pub(crate) mod ties;
