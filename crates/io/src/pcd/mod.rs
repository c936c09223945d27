//! Point clouds of the Point Cloud Library: ascii, binary and binary_compressed.

mod header;
mod parse;
mod write;

pub use parse::{parse, parse_within};
pub use write::write_cloud_pcd;
