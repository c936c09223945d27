//! The surface of a cloud: pieces of it about samples, and the edges between them.

pub(super) mod ball;
pub(super) mod edge;
pub(super) mod edges;
mod ends;
pub(super) mod join;
mod lazy;
pub(super) mod leaf;
pub(super) mod onward;
mod refine;
pub(super) mod room;
pub(super) mod slab;
pub(super) mod slots;
pub(super) mod surfel;
