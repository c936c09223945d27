//! What a cloud is on either path: filtered points, their position noise, an index and a tree.

use std::time::{Duration, Instant};

use cloudtouch_bvh::{LeafBounds, Primitive, Tree, TreeSettings};
use cloudtouch_geom::{Point3, PointCloud, UncertainPoint, UnitVector3, Vector3};
use cloudtouch_noise::{
    Combination, Neighborhoods, NoiseError, NoiseModel, NoiseSettings, SensorModel, SensorNoise,
};

use crate::error::PrepareError;
use crate::filter::{FilterSettings, StageReport, filter};
use crate::range::check_points;

use super::edge::DISC_SPACINGS;
use super::makeup::{Makeup, is_image};
use super::pieces::Pieces;
use super::slots::LazySurface;
use super::view::SingleView;

/// Points with more noise than half the size of their cloud say nothing.
const MOST_NOISE: f64 = 0.5;

/// What a path prepares a cloud by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Preparation<'a> {
    pub sensor: &'a SensorModel,
    pub filter: &'a FilterSettings,
    pub noise: NoiseSettings,
    pub tree: &'a TreeSettings,
}

impl Preparation<'_> {
    /// Checks every field.
    pub(crate) fn validate(&self) -> Result<(), PrepareError> {
        self.sensor.validate()?;
        self.filter.validate()?;
        self.noise.validate().map_err(NoiseError::from)?;
        Ok(self.tree.validate()?)
    }
}

/// A noisy cloud, ready to be queried in any pose, from many threads at once. Each path wraps it in
/// a type of its own.
#[derive(Debug)]
pub(crate) struct Prepared {
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
    pub(super) pieces: Pieces,
    pub(super) noise: NoiseModel,
    pub(super) tree: Tree,
    pub(super) surface: LazySurface,
    makeup: Makeup,
    view: Option<SingleView>,
    /// Where the sensor stood, in the local frame, where the cloud says so.
    sensor_origin: Option<Point3>,
    pub(super) prepare_time: Duration,
}

impl Prepared {
    /// Filters a cloud, models its sensor, and builds its index and tree. `weigh` says how much
    /// surface each of the points kept stands for in the coverage of a node.
    pub(crate) fn new(
        cloud: &PointCloud,
        by: &Preparation<'_>,
        weigh: impl Fn(&Neighborhoods, usize) -> f64,
    ) -> Result<Self, PrepareError> {
        let start = Instant::now();
        let span = tracing::debug_span!("prepare_cloud", points = cloud.len());
        let _entered = span.enter();
        by.validate()?;
        let filtered = filter(cloud, by.filter)?;
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
        let sensor = by.sensor.covariances(&kept)?;
        let normals = match (&kept.normals, by.noise.combination) {
            (Some(normals), Combination::SurfacePosterior) => Some(checked(normals)?),
            _ => None,
        };
        let origin = nalgebra::center(&low, &high).coords;
        let points: Vec<Point3> = kept.points.iter().map(|p| p - origin).collect();
        let neighborhoods = Neighborhoods::try_new(points)?;
        let makeup = Makeup::new(cloud, (by.sensor, &sensor), (&neighborhoods, origin), &stages);
        if makeup.std > MOST_NOISE * makeup.size() && makeup.size() > 0.0 {
            return Err(PrepareError::NoiseBeyondSize { std: makeup.std, size: makeup.size() });
        }
        // A surface that is known needs no others to be told from, and one point is as good as the next.
        let is_fitted = by.noise.combination == Combination::SurfacePosterior && normals.is_none();
        let pieces = match is_fitted {
            true => Pieces::chosen(&neighborhoods, &sensor)?,
            false => Pieces::all(),
        };
        let primitive = |index: usize| Primitive::Point {
            point: UncertainPoint {
                mean: neighborhoods.points()[index],
                covariance: sensor[index],
            },
            weight: weigh(&neighborhoods, index),
        };
        let indices = pieces.indices(&neighborhoods);
        let primitives = indices.iter().map(|&index| primitive(index)).collect();
        let mut tree = Tree::build(primitives, by.tree)?;
        let noise = NoiseModel::try_new(by.noise)?;
        let surface = LazySurface::new(&tree, indices.len());
        tree.set_leaf_bounds(|leaf| {
            let cap = surface.spacing_cap(leaf);
            let reach = DISC_SPACINGS * cap;
            let mut bounds = LeafBounds { std: 0.0, shift: 0.0, reach };
            for &piece in leaf.primitive_indices() {
                let point = noise.bounds(&sensor[indices[piece as usize]], cap);
                bounds.std = bounds.std.max(point.std);
                bounds.shift = bounds.shift.max(point.shift);
            }
            bounds
        })?;
        // An organised cloud is a depth image: one view, with unseen space behind it.
        let view = is_image(cloud).then(|| SingleView::new(kept.sensor_origin() - origin));
        // The origin is what a file says that does not know.
        let sensor_origin = Some(kept.sensor_origin())
            .filter(|place| *place != Point3::origin())
            .map(|place| place - origin);
        let prepare_time = start.elapsed();
        Ok(Self {
            origin,
            sensor,
            normals,
            rows: filtered.rows,
            stages,
            neighborhoods,
            pieces,
            noise,
            tree,
            surface,
            makeup,
            view,
            sensor_origin,
            prepare_time,
        })
    }

    pub(crate) fn len(&self) -> usize {
        self.sensor.len()
    }

    /// A kept point in the file's frame, m.
    pub(crate) fn point(&self, index: usize) -> Point3 {
        self.neighborhoods.points()[index] + self.origin
    }

    /// For every kept point its row in the input; empty when a collision map replaced the points.
    pub(crate) fn rows(&self) -> &[usize] {
        &self.rows
    }

    pub(crate) fn filter_stages(&self) -> &[StageReport] {
        &self.stages
    }

    pub(crate) fn prepare_time(&self) -> Duration {
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

    pub(crate) fn sensor_origin(&self) -> Option<&Point3> {
        self.sensor_origin.as_ref()
    }

    /// What the cloud is like as a whole.
    pub(crate) fn makeup(&self) -> &Makeup {
        &self.makeup
    }

    /// Distance of a place in the local frame to the nearest point, m.
    pub(crate) fn distance_to(&self, place: &Point3) -> Option<f64> {
        Some(self.neighborhoods.nearest_to(place, 1).first()?.squared_distance.sqrt())
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
