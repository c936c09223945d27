//! What other programs share with the `cloudtouch` tool: how its case files and options are read.

pub mod files;
pub mod intrinsics;
pub mod numbers;
pub mod sensor;
