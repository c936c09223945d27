//! What other programs share with the `cloudtouch` tool: how its case files and options are read.

mod case_fields;
pub mod case_file;
pub mod joints_file;
mod json_text;
mod near_name;
pub mod numbers;
pub mod path_text;
pub mod pose_text;
pub mod scene_file;
pub mod sensor;
