#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod cases;
mod options;
mod query;
mod readers;
#[cfg(feature = "mcap")]
mod recordings;

pub use cases::case_file;
pub use options::options;
pub use query::query;
pub use readers::{read_depth, read_obj, read_pcd, read_ply, read_pointcloud2, read_stl, read_xyz};

#[cfg(feature = "mcap")]
pub use recordings::read_mcap;

/// A target: takes bytes, and panics when the code under test does what it must not.
pub type Target = fn(&[u8]);

/// Every target under the name of its folder of seeds.
pub const TARGETS: &[(&str, Target)] = &[
    #[cfg(feature = "mcap")]
    ("read_mcap", read_mcap),
    ("read_depth", read_depth),
    ("read_pcd", read_pcd),
    ("read_ply", read_ply),
    ("read_pointcloud2", read_pointcloud2),
    ("read_xyz", read_xyz),
    ("read_stl", read_stl),
    ("read_obj", read_obj),
    ("case_file", case_file),
    ("options", options),
    ("query", query),
];
