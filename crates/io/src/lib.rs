#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod atomic;
mod builder;
mod camera_doubt;
mod column_names;
mod conversion;
pub mod depth;
mod depth_camera;
mod error;
mod fault;
mod geometry;
mod limits;
mod missing;
pub mod obj;
pub mod pcd;
pub mod ply;
pub mod pointcloud2;
mod polygon;
mod read;
pub mod recording;
mod recording_fault;
mod scalar;
pub mod stl;
mod text;
mod unit;
pub mod xyz;

/// Points, clouds and meshes, which is what is read and written.
pub use cloudtouch_geom as geom;

pub use atomic::{abandon_unfinished, write_atomically};
pub use camera_doubt::CameraDoubt;
pub use depth::is_depth_image;
pub use depth_camera::{CameraError, DepthCamera};
pub use error::{ReadError, WriteError};
pub use fault::{Fault, FormatError, Place};
pub use geometry::Geometry;
pub use limits::ReadLimits;
pub use obj::write_mesh_obj;
pub use pcd::write_cloud_pcd;
pub use ply::{write_cloud_ply, write_colored_ply};
pub use read::{
    check_extension, read_bytes, read_cloud, read_cloud_within, read_colors_within,
    read_depth_image, read_depth_image_within, read_geometry, read_geometry_within, read_mesh,
    read_mesh_within, read_scan_within, scaled_cloud,
};
pub use unit::{LengthUnit, UnknownUnit};
