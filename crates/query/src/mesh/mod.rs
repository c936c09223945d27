//! Triangle meshes prepared for queries: exact surfaces, with an inside where they are closed.

mod cells;
mod coverage;
mod near;
mod parts;
mod prepare;
mod project;
mod side;
mod subdivide;
mod surface;
mod winding;

pub use prepare::Mesh;
pub(crate) use subdivide::{SampleRegion, four_per_triangle, nearest_in_region, sample_region};
