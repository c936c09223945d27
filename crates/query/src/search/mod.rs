//! What two bodies say of a collision by their geometry alone: one search over pieces of surface,
//! noisy ones of clouds and exact ones of meshes.
//!
//! It gathers how far apart the surfaces are in standard deviations, how clearly one passes through
//! the other, and how deep a cloud is inside a closed mesh.

mod around;
mod beyond;
mod cells;
mod crossing;
mod crossings;
mod extent;
mod facet;
mod gather;
mod inside;
mod leaf;
mod leaves;
mod meeting;
mod nearest;
mod past;
mod run;
mod side;
mod swept;
mod through_mesh;
mod trees;
mod wrench;

pub(crate) use beyond::{least_beyond, may_be_within};
pub(crate) use crossing::Crossing;
pub(crate) use inside::{Inside, Looked, look_inside};
pub(crate) use leaf::{Leaf, NoisyLeaf};
pub(crate) use meeting::probability_at;
pub(crate) use run::{Finding, Found, search};
pub(crate) use swept::{greatest_depth, reach_of};
pub(crate) use wrench::{
    Changes, Wrench, force_at, in_object_frame, of_direction, of_place, way_to_triangle,
};
