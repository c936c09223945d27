//! Polygon files: point clouds or meshes, ascii or binary of either byte order.

mod body;
mod colors;
mod header;
mod parse;
mod write;

pub use colors::colors_within;
pub use parse::{parse, parse_within};
pub use write::{write_cloud_ply, write_colored_ply};
