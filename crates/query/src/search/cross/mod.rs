//! Whether one surface passes through the other.

pub(super) mod crossing;
pub(super) mod crossings;
pub(super) mod gather;
pub(super) mod leaves;
pub(super) mod near;
pub(super) mod near_discs;
pub(super) mod past;
mod places;
mod reached;
pub(super) mod side;
pub(super) mod through_mesh;
pub(super) mod with_all;
