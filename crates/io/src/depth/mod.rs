//! Depth images: 16-bit greyscale PNG with the intrinsics of its camera, as an organised cloud.

mod image;
mod parse;

pub use parse::{is_depth_image, parse, parse_within};
