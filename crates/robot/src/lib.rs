#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod at_fault;
mod carried;
mod checker;
mod elements;
mod error;
mod essential;
mod hold;
mod joint;
mod link;
mod may_touch;
mod motion;
mod nesting;
mod places;
mod primitive;
mod read;
mod robot;
mod root;
mod slips;
mod srdf;
mod stretch;
mod text;
mod tree;
mod uri;
mod ways;

pub use checker::{RobotChecker, SURROUNDINGS, Touching};
pub use error::{JointsError, PathError, RobotError, RobotFault, UnknownLink};
pub use joint::{Joint, JointKind, Mimic};
pub use motion::{Nearest, PathChecked, Stopped};
pub use primitive::EXCESS;
pub use robot::Robot;
