//! Files by their extension: opens, parses, converts to metres.

mod cloud;
mod colors;
mod depth_image;
mod file;
mod geometry;
mod mesh;

pub use cloud::{read_cloud, read_cloud_within, read_scan_within};
pub use colors::read_colors_within;
pub use depth_image::{read_depth_image, read_depth_image_within};
pub use file::{check_extension, read_bytes};
pub use geometry::{read_geometry, read_geometry_within, scaled_cloud};
pub use mesh::{read_mesh, read_mesh_within};
