#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod body;
mod cells;
mod check;
mod classifier;
mod cloud;
mod doubt;
mod error;
mod exact;
mod filter;
mod judge;
mod mesh;
mod mode;
mod motion;
pub mod paper;
mod placement;
mod query;
mod record;
mod report;
mod scene;
mod search;
mod shape;
mod some;
mod spiral;
mod stats;

pub use body::{Body, BodyRef};
pub use check::coordinates::LARGEST_COORDINATE;
pub use cloud::{Change, Cloud, CloudSettings};
pub use doubt::safeguards::Safeguards;
pub use doubt::undecided::Undecided;
pub use doubt::unseen::Unseen;
pub use doubt::warning::{Warning, Which};
pub use error::{
    ChangeError, FilterError, PrepareError, QueryError, SceneError, SettingsError, SubdivisionError,
};
pub use filter::{
    FilterSettings, Filtered, OutlierSettings, SelfMesh, StageReport, VeilSettings, filter,
};
pub use judge::{
    CROSSING_KNOTS, ContactEvidence, DEVIATION_KNOTS, DOUBT_KNOTS, EXTENT_KNOTS, EXTENT_NOISES,
    Judge, MISCLASSIFIED_KNOTS, NOISE_KNOTS, ODDS_KNOTS, OverDoubt, OverExtent, OverGeometry,
    WITHIN_KNOTS, WITHIN_NOISES, between_knots, sharp_extent,
};
pub use mesh::Mesh;
pub use mode::Mode;
pub use motion::{AlongPath, Path, Reached, SweepStats, Swept};
pub use paper::{
    PaperBodyRef, PaperCloud, PaperCloudSettings, PaperModel, PaperNoise, PaperQuery,
    PaperSettings, Pooling,
};
pub use placement::Placement;
pub use query::{
    Detail, NotFree, Penetration, PoseDistribution, PoseGradient, Query, QuerySettings, UnderPoses,
    Within,
};
pub use report::{Clearance, Contact, PointProbabilities, Report, Verdict};
pub use scene::{BodyWarning, Checked, Outside, PairAnswer, Scene};
pub use stats::Stats;

/// The crates below, for users who need their types: a query takes a [`geom::Pose`], a cloud a
/// [`noise::SensorModel`].
pub use cloudtouch_bvh as bvh;
pub use cloudtouch_geom as geom;
pub use cloudtouch_noise as noise;

/// Points with a smaller probability are not listed one by one.
pub const POINT_FLOOR: f64 = 1e-6;

/// Contacts with a smaller probability are not reported.
pub const CONTACT_FLOOR: f64 = 0.01;
