#![doc = include_str!("../README.md")]

mod ball;
mod clarabel_dual;
mod classifier;
mod cone;
mod gjk;
mod gram;
mod interior;
mod kernel;
mod problem;
mod rows;
mod sample;
mod separation;
mod settings;
mod smo;
mod solution;
mod solve;
mod state;
mod unit_box;
mod work;

pub use classifier::{Classifier, ClassifierError};
pub use kernel::Kernel;
pub use problem::{Problem, ProblemError};
pub use sample::{Class, Sample, balanced_penalties};
pub use separation::{DEFAULT_KAPPA_MAX, Separation, separate};
pub use settings::{Settings, SettingsError};
pub use solution::{Effort, Rung, Solution, Status};
pub use unit_box::UnitBox;
