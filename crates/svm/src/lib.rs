#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod active;
mod ball;
mod bias;
mod bounds;
mod choose;
#[cfg(feature = "clarabel")]
mod clarabel_dual;
mod classifier;
mod cone;
mod gjk;
mod gram;
mod interior;
mod kernel;
mod ladder;
mod lanes;
mod local;
mod newton;
mod plane_search;
mod problem;
mod rows;
mod sample;
mod separation;
mod settings;
mod smo;
mod solution;
mod solver;
mod spread;
mod state;
mod status;
mod unit_box;
mod watch;
mod work;

/// The plain data that samples are made of.
pub use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint, UnitVector3, Vector3};

pub use classifier::{Classifier, ClassifierError};
pub use kernel::Kernel;
pub use problem::{Problem, ProblemError};
pub use sample::{Class, Sample, balanced_penalties};
pub use separation::{DEFAULT_KAPPA_MAX, NoSeparation, Separation, separate};
pub use settings::{Settings, SettingsError};
pub use solution::{Effort, ErrorBounds, Solution, Undetermined};
pub use solver::Solver;
pub use status::{Ends, Rung, Status};
pub use unit_box::UnitBox;
pub use watch::Progress;
