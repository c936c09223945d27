//! What the files of the tool say: the cases of a batch, a scene, a path, a pose, positions of joints, a camera.

mod camera_info;
pub mod case;
mod case_fields;
mod distortion;
mod fields;
pub mod intrinsics;
pub mod joints;
mod json;
mod near_name;
pub mod path;
pub mod pose;
pub mod pose_table;
pub mod scene;
