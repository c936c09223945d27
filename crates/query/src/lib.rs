#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod body;
mod checks;
mod classifier;
mod cloud;
mod doubts;
mod enclosed;
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
mod range;
mod record;
mod report;
mod safeguards;
mod scene;
mod search;
mod shape;
mod undecided;
mod unseen;
mod warning;

pub use body::{Body, BodyRef};
pub use cloud::{Change, Cloud, CloudSettings};
pub use error::{
    ChangeError, FilterError, PrepareError, QueryError, SceneError, SettingsError, SubdivisionError,
};
pub use filter::{
    FilterSettings, Filtered, OutlierSettings, SelfMesh, StageReport, VeilSettings, filter,
};
pub use judge::{
    CROSSING_KNOTS, ContactEvidence, DEVIATION_KNOTS, DOUBT_KNOTS, EXTENT_KNOTS, Judge,
    MISCLASSIFIED_KNOTS, NOISE_KNOTS, ODDS_KNOTS, OverDoubt, OverExtent, OverGeometry,
    WITHIN_KNOTS, between_knots,
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
pub use report::{Clearance, Contact, PointProbabilities, Report, Stats, Unseen, Verdict};
pub use safeguards::Safeguards;
pub use scene::{Checked, Outside, PairAnswer, Scene};
pub use undecided::Undecided;
pub use warning::{Warning, Which};

/// The crates below, for users who need their types: a query takes a [`geom::Pose`], a cloud a
/// [`noise::SensorModel`].
pub use cloudtouch_bvh as bvh;
pub use cloudtouch_geom as geom;
pub use cloudtouch_noise as noise;

/// Points with a smaller probability are not listed one by one.
pub const POINT_FLOOR: f64 = 1e-6;

/// Triangles that a mesh is split into at most where nothing else is said: their points take about
/// 500 MB.
pub const MAX_MESH_PARTS: usize = 5_000_000;

/// Contacts with a smaller probability are not reported.
pub const CONTACT_FLOOR: f64 = 0.01;
