//! What geometry could say of a collision at any pose of a motion, at most: the search at its middle,
//! with all that the motion can add.

mod anywhere;
mod course;
mod depth;
mod dividing;
mod drifts;
mod facets;
mod gather;
mod hull;
mod layer;
mod leaf;
mod passage;
mod pieces;
mod plane;
mod pool;
mod run;
mod track;

pub(crate) use anywhere::reach_around;
pub(crate) use depth::greatest_depth;
pub(crate) use run::reach_of;
