//! Triangle meshes of our own design: primitives, a grand piano, a room; in metres, z up.
//!
//! Solids are watertight and consistently oriented; a scene may be several closed components that
//! keep 5 mm apart, so that no surface lies inside another component.

mod assemble;
mod furniture;
mod piano;
mod polygon;
mod primitives;
mod refine;
mod room;
mod round;
mod union;

pub use assemble::{assemble, moved};
pub use piano::piano;
pub use primitives::{
    crossing_sheets, cuboid, cylinder, peg, plane_patch, plate_with_hole, rectangle, sphere,
    thin_slab, torus, wedge,
};
pub use refine::subdivide_to_max_edge;
pub use room::room;
pub use round::{arc, revolved, revolved_ring, rounded, tube};
pub use union::union_of_boxes;
