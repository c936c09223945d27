//! From the points of a file to a cloud that can be asked.

use std::time::{Duration, Instant};

use cloudtouch_bvh::{LeafBounds, Primitive, Tree};
use cloudtouch_geom::{Point3, PointCloud, UncertainPoint, UnitVector3, Vector3};
use cloudtouch_noise::{Combination, Neighborhoods, NoiseModel, SensorNoise};

use crate::error::PrepareError;
use crate::filter::{StageReport, filter};
use crate::range::check_points;

use super::edge::DISC_SPACINGS;
use super::settings::CloudSettings;
use super::slots::LazySurface;
use super::view::SingleView;

/// A noisy cloud, ready to be queried in any pose, from many threads at once.
#[derive(Debug)]
pub struct Cloud {
    /// What was subtracted from file coordinates, m: far offsets keep their millimetres.
    origin: Vector3,
    /// Position noise of each point (Σ of the paper).
    pub(super) sensor: SensorNoise,
    /// Unit normals, where the surface is known.
    pub(super) normals: Option<Vec<UnitVector3>>,
    rows: Vec<usize>,
    stages: Vec<StageReport>,
    /// The points kept by the filter, in the local frame, and which are near which.
    pub(super) neighborhoods: Neighborhoods,
    pub(super) noise: NoiseModel,
    pub(super) tree: Tree,
    pub(super) surface: LazySurface,
    view: Option<SingleView>,
    pub(super) prepare_time: Duration,
}

impl Cloud {
    /// Filters a cloud, models its sensor, and builds its index and tree.
    ///
    /// # Errors
    /// When nothing is left after filtering, a coordinate is beyond 1e10 m, a covariance is not one,
    /// or a setting is out of range.
    pub fn prepare(cloud: &PointCloud, settings: &CloudSettings) -> Result<Self, PrepareError> {
        let start = Instant::now();
        let span = tracing::debug_span!("prepare_cloud", points = cloud.len());
        let _entered = span.enter();
        settings.validate()?;
        let filtered = filter(cloud, &settings.filter)?;
        let stages = filtered.stages;
        let kept = filtered.cloud;
        let Some((low, high)) = kept.bounding_box() else {
            let removed: Vec<String> =
                stages.iter().map(|s| format!("{} removed {}", s.stage, s.removed)).collect();
            return Err(PrepareError::NothingLeft {
                before: cloud.len(),
                stages: removed.join(", "),
            });
        };
        // By their rows in the file; the cells of a collision map have none.
        let row = |i: usize| filtered.rows.get(i).copied().unwrap_or(i);
        check_points(kept.points.iter().enumerate().map(|(i, p)| (row(i), p)))?;
        let sensor = settings.sensor.covariances(&kept)?;
        let normals = match (&kept.normals, settings.noise.combination) {
            (Some(normals), Combination::SurfacePosterior) => Some(checked(normals)?),
            _ => None,
        };
        let origin = nalgebra::center(&low, &high).coords;
        let points: Vec<Point3> = kept.points.iter().map(|p| p - origin).collect();
        let primitives = points
            .iter()
            .zip(sensor.iter())
            .map(|(&mean, &covariance)| Primitive::Point {
                point: UncertainPoint { mean, covariance },
                weight: 1.0,
            })
            .collect();
        let neighborhoods = Neighborhoods::try_new(points)?;
        let mut tree = Tree::build(primitives, &settings.tree)?;
        let noise = NoiseModel::try_new(settings.noise)?;
        let surface = LazySurface::new(&tree, sensor.len());
        tree.set_leaf_bounds(|leaf| {
            let cap = surface.spacing_cap(leaf);
            let reach = DISC_SPACINGS * cap;
            let mut bounds = LeafBounds { std: 0.0, shift: 0.0, reach };
            for &index in leaf.primitive_indices() {
                let point = noise.bounds(&sensor[index as usize], cap);
                bounds.std = bounds.std.max(point.std);
                bounds.shift = bounds.shift.max(point.shift);
            }
            bounds
        })?;
        // An organised cloud is a depth image: one view, with unseen space behind it.
        let view = cloud
            .image_size
            .filter(|&(width, height)| width > 1 && height > 1)
            .map(|_| SingleView::new(kept.sensor_origin() - origin));
        let prepare_time = start.elapsed();
        Ok(Self {
            origin,
            sensor,
            normals,
            rows: filtered.rows,
            stages,
            neighborhoods,
            noise,
            tree,
            surface,
            view,
            prepare_time,
        })
    }

    /// How many points the filter kept.
    pub fn len(&self) -> usize {
        self.sensor.len()
    }

    /// Never true: preparing an empty cloud is an error.
    pub fn is_empty(&self) -> bool {
        self.sensor.is_empty()
    }

    /// A kept point in the file's frame, m.
    ///
    /// # Panics
    /// When the index is out of range.
    pub fn point(&self, index: usize) -> Point3 {
        self.neighborhoods.points()[index] + self.origin
    }

    /// For every kept point its row in the input; empty when a collision map replaced the points.
    pub fn rows(&self) -> &[usize] {
        &self.rows
    }

    /// What the filter removed, stage by stage.
    pub fn filter_stages(&self) -> &[StageReport] {
        &self.stages
    }

    /// How long preparation took.
    pub fn prepare_time(&self) -> Duration {
        self.prepare_time
    }

    pub(crate) fn origin(&self) -> Vector3 {
        self.origin
    }

    /// The points kept by the filter, in the local frame.
    pub(crate) fn points(&self) -> &[Point3] {
        self.neighborhoods.points()
    }

    /// Position noise of the points kept by the filter.
    pub(crate) fn sensor(&self) -> &SensorNoise {
        &self.sensor
    }

    /// The largest standard deviation of the position noise of a kept point, m.
    pub(crate) fn sensor_std(&self, index: u32) -> f64 {
        self.sensor[index as usize].max_std()
    }

    pub(crate) fn tree(&self) -> &Tree {
        &self.tree
    }

    pub(crate) fn view(&self) -> Option<&SingleView> {
        self.view.as_ref()
    }
}

/// Normals as they are, after a look at them: a `Unit` can be made without a check.
fn checked(normals: &[UnitVector3]) -> Result<Vec<UnitVector3>, PrepareError> {
    let checked = |(index, normal): (usize, &UnitVector3)| {
        let is_unit = (normal.norm() - 1.0).abs() < 1e-6;
        if is_unit {
            Ok(*normal)
        } else {
            Err(PrepareError::Normal { index, normal: normal.into_inner() })
        }
    };
    normals.iter().enumerate().map(checked).collect()
}
