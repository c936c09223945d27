//! What sensors delivered, made ready: scans filtered, each with the noise of its sensor, and put
//! together in one frame.

mod noise;
mod others;
mod refused;

use std::mem;
use std::sync::Arc;

use cloudtouch_geom::{Covariance, Point3, PointCloud, UnitVector3};
use cloudtouch_noise::{Combination, SensorNoise};

use crate::check::coordinates::{bad_entry, check_points};
use crate::error::PrepareError;
use crate::filter::{Filtered, StageReport, Taken, filter_and_tell, measured};

use self::noise::{coarse_step, joined, noise_of, padded};
use self::others::{beyond_range, other_returns};
use self::refused::{by_row, check_for_repeats, checked, nothing_left, of_scan};
use super::makeup::layout::Layout;
use super::makeup::{SensorDoubt, missing, robot_doubt, sensor_doubts};
use super::preparation::Preparation;
use super::view::Image;
use super::view::range::{self, Range};

/// Scans in one frame.
#[derive(Debug, Clone)]
pub(super) struct Scans {
    pub points: Arc<Vec<Point3>>,
    /// Position noise of each point.
    pub noise: SensorNoise,
    /// Where they are to be used, and every scan has them.
    pub normals: Option<Vec<UnitVector3>>,
    /// Of each point its row, counted on through the scans; empty after a collision map.
    pub rows: Vec<usize>,
    /// Rows that the scans had.
    pub row_count: usize,
    pub stages: Vec<StageReport>,
    /// Where sensors stood, of scans that say so.
    pub origins: Vec<Point3>,
    /// The largest share of rows without return of a scan whose layout does not tell where.
    pub missing: f64,
    /// How far apart coordinates are, m, of a scan where that is more than its noise.
    pub step: Option<f64>,
    /// Signs that a sensor did not see its scan.
    pub sensor_doubts: Vec<SensorDoubt>,
    /// What was taken for the robot and may be of something beside it.
    pub taken: Vec<Taken>,
    /// Scans that are depth images and were not looked through yet.
    pub images: Vec<Image>,
    /// How far the others tell.
    pub ranges: Vec<Range>,
}

impl Scans {
    pub(super) fn of(scans: &[(&PointCloud, Preparation<'_>)]) -> Result<Self, PrepareError> {
        let mut all = Self::none();
        let (mut noise, mut ends) = (Vec::new(), Vec::new());
        for &(scan, by) in scans {
            let which = ends.len();
            let mut one = Self::of_one(scan, by).map_err(|e| of_scan(e, which, scans.len()))?;
            // Put together at the end: what differs from point to point is then copied once.
            noise.push(mem::replace(&mut one.noise, SensorNoise::from(Vec::new())));
            all.add(one);
            ends.push(all.points.len());
        }
        check_for_repeats(&all.points, &ends)?;
        all.noise = joined(&noise.iter().collect::<Vec<_>>());
        Ok(all)
    }

    /// To put others behind.
    fn none() -> Self {
        Self {
            points: Arc::default(),
            noise: SensorNoise::from(Vec::new()),
            normals: Some(Vec::new()),
            rows: Vec::new(),
            row_count: 0,
            stages: Vec::new(),
            origins: Vec::new(),
            missing: 0.0,
            step: None,
            sensor_doubts: Vec::new(),
            taken: Vec::new(),
            images: Vec::new(),
            ranges: Vec::new(),
        }
    }

    /// One scan.
    fn of_one(scan: &PointCloud, by: Preparation<'_>) -> Result<Self, PrepareError> {
        by.validate()?;
        if let Some(value) = scan.sensor_pose.as_ref().and_then(bad_entry) {
            return Err(PrepareError::SensorPose { value });
        }
        let measured = measured(scan, by.filter, by.sensor);
        let by = Preparation { filter: measured.as_ref().unwrap_or(by.filter), ..by };
        let (Filtered { cloud: kept, rows, stages }, removed) =
            filter_and_tell(scan, by.filter, by.sensor)?;
        if kept.is_empty() {
            return Err(nothing_left(scan.len(), &stages));
        }
        // By their rows in the file; the cells of a collision map have none.
        let row = |i: usize| rows.get(i).copied().unwrap_or(i);
        check_points(kept.points.iter().enumerate().map(|(i, p)| (row(i), p)))?;
        let noise = noise_of(&kept, by).map_err(|error| by_row(error, row))?;
        let normals = match (&kept.normals, by.noise.combination) {
            (Some(normals), Combination::SurfacePosterior) => Some(checked(normals, row)?),
            _ => None,
        };
        let layout = scan.is_image().then(|| Layout::of(scan, by.sensor, &kept.points));
        let mut sensor_doubts = sensor_doubts(scan, by.sensor, &kept.points, layout);
        sensor_doubts.extend(robot_doubt(&stages));
        let (taken, doubt) = padded(&scan.select(&removed.robot), &kept.points, by)?;
        sensor_doubts.extend(doubt);
        let (mut images, mut ranges) = (Vec::new(), Vec::new());
        if let Some(Layout { scanner, .. }) = layout {
            // A robot that no return came from is elsewhere, and makes nothing known.
            let robot = if removed.robot.is_empty() { Vec::new() } else { by.filter.robot.clone() };
            let beyond = beyond_range(scan, by)?;
            let others = other_returns(scan, &removed, by)?;
            images.push(Image::of((scan, scanner), (&kept, &rows), robot, &beyond, &others));
        } else {
            ranges.push(Range { sensor_origin: scan.sensor_origin(), most: by.filter.max_range });
        }
        Ok(Self {
            normals,
            row_count: scan.len(),
            origins: kept.sensor_pose.iter().map(|pose| Point3::from(pose.translation())).collect(),
            missing: missing(scan, &stages),
            step: coarse_step(&kept.points, &noise),
            noise,
            sensor_doubts,
            taken: taken.into_iter().collect(),
            images,
            ranges,
            points: kept.points.into(),
            rows,
            stages,
        })
    }

    /// Puts others of the same frame behind these, as if all had been given at once.
    pub(super) fn append(&mut self, others: Self) {
        // One sign of each kind is enough, the last: a camera delivers frames for hours.
        let kind = mem::discriminant::<SensorDoubt>;
        let later = &others.sensor_doubts;
        self.sensor_doubts.retain(|doubt| !later.iter().any(|other| kind(other) == kind(doubt)));
        if others.images.iter().any(|image| image.is_later) {
            // The robot is elsewhere by now, and what it still hides beside it comes with the others.
            self.taken.clear();
        }
        self.noise = joined(&[&self.noise, &others.noise]);
        self.add(others);
    }

    /// Puts all but the noise of others behind these.
    fn add(&mut self, others: Self) {
        let before = self.points.len();
        let shifted = |image: Image| Image {
            points: before + image.points.start..before + image.points.end,
            ..image
        };
        self.images.extend(others.images.into_iter().map(shifted));
        others.ranges.into_iter().for_each(|other| range::add(&mut self.ranges, other));
        self.normals = match (self.normals.take(), others.normals) {
            (Some(mut own), Some(others)) => {
                append(&mut own, others);
                Some(own)
            }
            _ => None,
        };
        if self.rows.len() != self.points.len() || others.rows.len() != others.points.len() {
            self.rows.clear();
        } else {
            let mut rows = others.rows;
            rows.iter_mut().for_each(|row| *row += self.row_count);
            append(&mut self.rows, rows);
        }
        self.row_count += others.row_count;
        self.stages.extend(others.stages);
        self.origins.extend(others.origins);
        self.missing = self.missing.max(others.missing);
        self.step = self.step.into_iter().chain(others.step).max_by(f64::total_cmp);
        self.sensor_doubts.extend(others.sensor_doubts);
        self.taken.extend(others.taken);
        append(Arc::make_mut(&mut self.points), Arc::unwrap_or_clone(others.points));
    }

    /// Whether the noise of all points is the same, and normals are known, in both or in neither.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let kind = |all: &Self| (all.noise.as_uniform().is_some(), all.normals.is_some());
        kind(self) == kind(other)
    }

    /// The same without copies of points, as a stage that drops duplicates leaves it.
    pub(super) fn kept_once(&self, kept: &[u32]) -> Self {
        let before = self.points.len();
        let mut once = self.kept(kept);
        once.stages.push(StageReport { stage: "duplicates", before, removed: before - kept.len() });
        once
    }

    /// The same with only these points, given in order.
    pub(super) fn kept(&self, kept: &[u32]) -> Self {
        fn of<T: Copy>(all: &[T], kept: &[u32]) -> Vec<T> {
            kept.iter().map(|&index| all[index as usize]).collect()
        }
        let noise = match self.noise.as_uniform() {
            Some(same) => SensorNoise::uniform(*same, kept.len()),
            None => {
                let each: Vec<Covariance> = kept.iter().map(|&i| self.noise[i as usize]).collect();
                each.into()
            }
        };
        // What was to be doubted of points that are gone says nothing of those that come.
        let is_gone = kept.is_empty();
        Self {
            points: of(&self.points, kept).into(),
            noise,
            normals: self.normals.as_ref().map(|normals| of(normals, kept)),
            rows: if self.rows.is_empty() { Vec::new() } else { of(&self.rows, kept) },
            stages: self.stages.clone(),
            origins: self.origins.clone(),
            sensor_doubts: if is_gone { Vec::new() } else { self.sensor_doubts.clone() },
            missing: if is_gone { 0.0 } else { self.missing },
            step: self.step.filter(|_| !is_gone),
            taken: if is_gone { Vec::new() } else { self.taken.clone() },
            images: self.images.clone(),
            ranges: self.ranges.clone(),
            ..*self
        }
    }
}

/// Puts a list behind another, without a copy of the first that comes.
fn append<T>(all: &mut Vec<T>, mut others: Vec<T>) {
    if all.is_empty() {
        *all = others;
    } else {
        all.append(&mut others);
    }
}
