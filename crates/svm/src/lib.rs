#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod bounds;
mod certificate;
#[cfg(feature = "clarabel")]
mod clarabel_dual;
mod classifier;
mod interior;
mod lanes;
mod plane;
mod problem;
mod smo;
mod solution;
mod solver;
mod status;
mod watch;

/// The plain data that samples are made of; and all that there is beside it.
pub use cloudtouch_geom as geom;
pub use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint, UnitVector3, Vector3};

pub use classifier::{Classifier, ClassifierError};
pub use plane::{DEFAULT_KAPPA_MAX, NoSeparation, Separation, separate};
pub use problem::kernel::Kernel;
pub use problem::sample::{Class, Sample, balanced_penalties};
pub use problem::unit_box::UnitBox;
pub use problem::{Problem, ProblemError};
pub use solution::{Effort, ErrorBounds, Solution, Undetermined};
pub use solver::Solver;
pub use solver::settings::{Settings, SettingsError};
pub use status::{Ends, Rung, Status};
pub use watch::Progress;
