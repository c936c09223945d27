//! What other programs share with the `cloudtouch` tool: how its case files are read.

pub mod case_file;
