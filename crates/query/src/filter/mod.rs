//! The cleaning pipeline of the paper's section 3: what a sensor delivers in, what a query should
//! see out, with a count for every stage.

mod collision_map;
mod duplicates;
mod going_on;
mod lines;
mod missing;
mod near;
mod outliers;
mod range;
mod self_points;
mod settings;
mod taken;
mod veil;

use cloudtouch_geom::PointCloud;
use cloudtouch_noise::SensorModel;
use serde::Serialize;

use crate::error::FilterError;

pub(crate) use range::{is_return_to, measured};
pub use self_points::SelfMesh;
pub use settings::{FilterSettings, OutlierSettings, VeilSettings};
pub(crate) use taken::Taken;

/// How many points one stage took away.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct StageReport {
    /// What the stage does: `missing`, `range`, `duplicates`, `robot`, `veil`, `outliers` or
    /// `collision map`.
    pub stage: &'static str,
    /// Points before it.
    pub before: usize,
    /// Points it removed.
    pub removed: usize,
}

/// What is left of a cloud, and what went where.
#[derive(Debug, Clone, PartialEq)]
pub struct Filtered {
    /// The points kept, in their order in the input (cell centres, after a collision map).
    pub cloud: PointCloud,
    /// For every point kept, its row in the input; empty after a collision map, whose cells stand
    /// for many rows.
    pub rows: Vec<usize>,
    /// One entry for each stage that ran, in order.
    pub stages: Vec<StageReport>,
}

/// Runs the stages that `settings` asks for, cheapest first.
///
/// Rows with a coordinate that is NaN, infinite or beyond ±1e30 m always go: missing returns. So do rows at
/// the origin or at the place of the sensor, one in an image and three elsewhere, which stand for none, and, by the
/// stage `range`, returns so far from a stereo camera that no disparity tells how far ([`SensorModel::farthest`]), unless
/// these are more than a tenth. A stage that has nothing to work with (no
/// image layout and no neighbours, for instance) removes nothing. Every stage can only remove
/// points, so each can hide a true obstacle; the counts tell how many points that concerns. The `sensor` tells how far a
/// surface may be off a line for noise, by which steep surfaces and veils are told apart.
///
/// # Errors
/// When a setting is out of range, or the cloud does not have a covariance for each point or a point
/// for each pixel; see [`FilterError`].
pub fn filter(
    cloud: &PointCloud,
    settings: &FilterSettings,
    sensor: &SensorModel,
) -> Result<Filtered, FilterError> {
    let measured = measured(cloud, settings, sensor);
    Ok(filter_and_tell(cloud, measured.as_ref().unwrap_or(settings), sensor)?.0)
}

/// Rows that went, of those a view has to know, in order.
#[derive(Debug, Clone, Default)]
pub(crate) struct Removed {
    /// What was nearer than was said to be near enough, but for specks.
    pub near: Vec<usize>,
    /// What was taken for the robot.
    pub robot: Vec<usize>,
    /// What was taken for veil.
    pub veil: Vec<usize>,
    /// What was taken for outliers.
    pub outliers: Vec<usize>,
    /// What cells of a collision map stand for.
    pub mapped: Vec<usize>,
}

/// The same, with what went.
pub(crate) fn filter_and_tell(
    cloud: &PointCloud,
    settings: &FilterSettings,
    sensor: &SensorModel,
) -> Result<(Filtered, Removed), FilterError> {
    settings.validate()?;
    check_lengths(cloud)?;
    let mut run = Run { cloud, kept: (0..cloud.len()).collect(), stages: Vec::new() };
    let mut removed = Removed::default();
    run.stage("missing", missing::drop_missing);
    if settings.min_range != Some(0.0) || settings.max_range.is_finite() {
        run.stage("range", |cloud, kept| range::keep_in_range(cloud, kept, settings));
        removed.near = near::too_near(cloud, settings);
    }
    if settings.drop_duplicates {
        run.stage("duplicates", duplicates::keep_one);
    }
    if !settings.robot.is_empty() {
        run.stage("robot", |cloud, kept| {
            removed.robot = self_points::keep_outside(cloud, kept, &settings.robot);
        });
    }
    if let Some(veil) = &settings.veil {
        run.stage("veil", |cloud, kept| {
            removed.veil = veil::drop_veil(cloud, kept, veil, sensor);
        });
    }
    if let Some(outliers) = &settings.outliers {
        run.stage("outliers", |cloud, kept| {
            removed.outliers = outliers::drop_outliers(cloud, kept, outliers);
        });
    }
    let Run { kept, mut stages, .. } = run;
    let mut filtered = cloud.select(&kept);
    let mut rows = kept;
    if let Some(resolution) = settings.collision_map {
        let before = filtered.len();
        filtered = collision_map::cell_centers(&filtered, resolution)?;
        removed.mapped = std::mem::take(&mut rows);
        let stage = "collision map";
        stages.push(StageReport { stage, before, removed: before - filtered.len() });
    }
    Ok((Filtered { cloud: filtered, rows, stages }, removed))
}

fn check_lengths(cloud: &PointCloud) -> Result<(), FilterError> {
    let points = cloud.len();
    let counts = [
        ("covariances", cloud.covariances.as_ref().map(Vec::len)),
        ("normals", cloud.normals.as_ref().map(Vec::len)),
    ];
    for (what, count) in counts {
        if let Some(count) = count.filter(|&count| count != points) {
            return Err(FilterError::Count { what, count, points });
        }
    }
    match cloud.image_size {
        Some((width, height)) if width.checked_mul(height) != Some(points) => {
            Err(FilterError::ImageSize { points, width, height })
        }
        _ => Ok(()),
    }
}

struct Run<'a> {
    cloud: &'a PointCloud,
    kept: Vec<usize>,
    stages: Vec<StageReport>,
}

impl Run<'_> {
    fn stage(&mut self, stage: &'static str, retain: impl FnOnce(&PointCloud, &mut Vec<usize>)) {
        let before = self.kept.len();
        retain(self.cloud, &mut self.kept);
        let removed = before - self.kept.len();
        tracing::debug!(stage, before, removed, "filter");
        self.stages.push(StageReport { stage, before, removed });
    }
}
