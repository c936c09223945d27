//! Point clouds of the Point Cloud Library: ascii, binary and binary_compressed.

mod colors;
mod header;
mod parse;
mod write;

pub use colors::colors_within;
pub use parse::{parse, parse_within};
pub use write::write_cloud_pcd;
