#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

pub mod brute;
pub mod camera;
pub mod exact;
pub mod facing;
pub mod family;
pub mod hard_cases;
pub mod measured;
pub mod noise;
pub mod poses;
pub mod poses_by_class;
mod random;
pub mod scene;
pub mod surface;
pub mod workshop;
