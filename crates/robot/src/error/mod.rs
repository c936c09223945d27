//! What can be wrong with the input, in words.

mod description;
mod joints;
mod link;

pub use description::{RobotError, RobotFault};
pub use joints::{JointsError, PathError};
pub use link::UnknownLink;
