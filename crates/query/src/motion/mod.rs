//! Continuous collision: how likely two bodies collide anywhere along a path, nothing between poses
//! missed.

mod along;
mod bound;
mod interval;
mod leg;
mod misgivings;
mod path;
mod stretch;
mod sweep;
mod swept;
mod tested;

pub use path::Path;
pub use swept::{AlongPath, Reached, SweepStats, Swept};
