//! Triangle meshes prepared for queries: exact surfaces, with an inside where they are closed.

mod around;
mod cells;
mod coverage;
mod near;
mod nearest_samples;
mod parts;
mod prepare;
mod project;
mod side;
mod sides;
mod solids;
mod subdivide;
mod surface;
mod winding;

pub(crate) use nearest_samples::nearest_in_region;
pub use prepare::Mesh;
pub(crate) use sides::Sides;
pub(crate) use subdivide::{SampleRegion, four_per_triangle, sample_region};
