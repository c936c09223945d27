//! What two bodies say of a collision by their geometry alone: one search over pieces of surface,
//! noisy ones of clouds and exact ones of meshes.
//!
//! It gathers how far apart the surfaces are in standard deviations, how clearly one passes through
//! the other, and how deep a cloud is inside a closed mesh.

mod add;
mod compare;
mod cross;
mod extent;
mod in_mesh;
mod measure;
mod run;
mod swept;
mod visit;
mod wrench;

pub(crate) use compare::meeting::probability_at;
pub(crate) use cross::crossing::Crossing;
pub(crate) use measure::beyond::{
    Span, least_beyond, least_of_leaves, least_within, may_be_within,
};
pub(crate) use measure::inside::{Inside, Looked, is_enough_of_leaf, look_inside};
pub(crate) use measure::nearest::Nearest;
pub(crate) use run::{
    Course, Finding, Found, Progress, SOUGHT, WITH_EXTENT, WITHOUT_EXTENT, search,
};
pub(crate) use swept::{greatest_depth, reach_around, reach_of};
pub(crate) use visit::leaf::{Leaf, NoisyLeaf};
pub(crate) use wrench::{
    Changes, Wrench, force_at, in_object_frame, of_direction, of_place, way_to_triangle,
};
