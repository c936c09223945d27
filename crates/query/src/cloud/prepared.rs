//! What a cloud is on either path: filtered points, their position noise, an index and a tree.

use std::time::{Duration, Instant};

use cloudtouch_bvh::{LeafBounds, Primitive, Tree, TreeSettings};
use cloudtouch_geom::{Covariance, Point3, PointCloud, UncertainPoint, UnitVector3, Vector3};
use cloudtouch_noise::{
    Combination, MotionNoise, Neighborhoods, NoiseError, NoiseModel, NoiseSettings, Scratch,
    SensorModel, SensorNoise, typical_spacing,
};

use crate::error::PrepareError;
use crate::filter::{FilterSettings, StageReport, filter};
use crate::range::check_points;

use super::edge::DISC_SPACINGS;
use super::slots::LazySurface;
use super::view::SingleView;

/// Relative rounding of an eigenvalue, generously.
const ROUNDING: f64 = 1e-9;
/// Points whose neighbours tell the typical spacing.
const SPACING_SAMPLE: usize = 200;

/// What a path prepares a cloud by.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Preparation<'a> {
    pub sensor: &'a SensorModel,
    pub filter: &'a FilterSettings,
    pub noise: NoiseSettings,
    pub tree: &'a TreeSettings,
    /// Added to what the sensor makes of position noise.
    pub motion: MotionNoise,
}

impl Preparation<'_> {
    /// Checks every field.
    pub(crate) fn validate(&self) -> Result<(), PrepareError> {
        self.sensor.validate()?;
        self.motion.validate()?;
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
    pub(super) noise: NoiseModel,
    pub(super) tree: Tree,
    pub(super) surface: LazySurface,
    view: Option<SingleView>,
    /// Where the sensor stood, in the local frame, where the cloud says so.
    sensor_origin: Option<Point3>,
    /// r of the ellipsoid of each point (eq. 11, 12), where they bring their own; else empty.
    radii: Vec<f64>,
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
        let sensor = moved(by.sensor.covariances(&kept)?, &by.motion, &kept.points);
        let normals = match (&kept.normals, by.noise.combination) {
            (Some(normals), Combination::SurfacePosterior) => Some(checked(normals)?),
            _ => None,
        };
        let origin = nalgebra::center(&low, &high).coords;
        let points: Vec<Point3> = kept.points.iter().map(|p| p - origin).collect();
        let neighborhoods = Neighborhoods::try_new(points)?;
        let primitives = neighborhoods
            .points()
            .iter()
            .zip(sensor.iter())
            .enumerate()
            .map(|(index, (&mean, &covariance))| Primitive::Point {
                point: UncertainPoint { mean, covariance },
                weight: weigh(&neighborhoods, index),
            })
            .collect();
        let mut tree = Tree::build(primitives, by.tree)?;
        let noise = NoiseModel::try_new(by.noise)?;
        let surface = LazySurface::new(&tree, sensor.len());
        let mut scratch = Scratch::default();
        tree.set_leaf_bounds(|leaf| {
            let cap = surface.spacing_cap(leaf);
            let reach = DISC_SPACINGS * cap;
            let mut bounds = LeafBounds { std: 0.0, shift: 0.0, reach };
            for &index in leaf.primitive_indices() {
                let index = index as usize;
                let point = noise.bounds(&sensor[index], cap);
                let std = if point.std.is_finite() {
                    point.std
                } else {
                    // What only the neighbours tell, they are asked for.
                    let refined = noise.refine(index, &neighborhoods, &sensor, cap, &mut scratch);
                    refined.point.covariance.max_std() * (1.0 + ROUNDING)
                };
                bounds.std = bounds.std.max(std);
                bounds.shift = bounds.shift.max(point.shift);
            }
            bounds
        })?;
        // An organised cloud is a depth image: one view, with unseen space behind it.
        let view = cloud
            .image_size
            .filter(|&(width, height)| width > 1 && height > 1)
            .map(|_| SingleView::new(kept.sensor_origin() - origin));
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
            noise,
            tree,
            surface,
            view,
            sensor_origin,
            radii: Vec::new(),
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

    /// r of the ellipsoid of a point, where it brings one of its own.
    pub(crate) fn ellipsoid_radius(&self, index: u32) -> Option<f64> {
        self.radii.get(index as usize).copied()
    }

    /// Gives each point an ellipsoid of its own.
    pub(crate) fn set_radii(&mut self, radii: Vec<f64>) {
        self.radii = radii;
    }

    pub(crate) fn tree(&self) -> &Tree {
        &self.tree
    }

    pub(crate) fn sensor_origin(&self) -> Option<&Point3> {
        self.sensor_origin.as_ref()
    }

    /// Distance between neighbouring points, m, as the median of some of them.
    pub(crate) fn typical_spacing(&self) -> f64 {
        typical_spacing(&self.neighborhoods, SPACING_SAMPLE)
    }

    pub(crate) fn view(&self) -> Option<&SingleView> {
        self.view.as_ref()
    }
}

/// Σ of points that may have moved since they were seen.
fn moved(sensor: SensorNoise, motion: &MotionNoise, points: &[Point3]) -> SensorNoise {
    if *motion == MotionNoise::default() {
        return sensor;
    }
    let sum = |(seen, place): (&Covariance, &Point3)| seen.sum(&motion.covariance(place));
    SensorNoise::from(sensor.iter().zip(points).map(sum).collect::<Vec<_>>())
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
