//! What sensors delivered, made ready: scans filtered, each with the noise of its sensor, and put
//! together in one frame.

use cloudtouch_geom::{Covariance, Point3, PointCloud, UnitVector3};
use cloudtouch_noise::{Combination, MotionNoise, Places, SensorNoise};

use crate::check::coordinates::check_points;
use crate::check::rounded::single_step;
use crate::error::PrepareError;
use crate::filter::{StageReport, beyond_noise, filter_and_tell};

use super::makeup::{SensorDoubt, missing, robot_doubt, sensor_doubts};
use super::preparation::Preparation;
use super::view::Image;
use super::view::range::{self, Range};

/// Scans in one frame.
#[derive(Debug, Clone)]
pub(super) struct Scans {
    pub points: Vec<Point3>,
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
    /// Scans that are depth images and were not looked through yet.
    pub images: Vec<Image>,
    /// How far the others tell.
    pub ranges: Vec<Range>,
}

impl Scans {
    pub(super) fn of(scans: &[(&PointCloud, Preparation<'_>)]) -> Result<Self, PrepareError> {
        let mut all = Self {
            points: Vec::new(),
            noise: SensorNoise::from(Vec::new()),
            normals: None,
            rows: Vec::new(),
            row_count: 0,
            stages: Vec::new(),
            origins: Vec::new(),
            missing: 0.0,
            step: None,
            sensor_doubts: Vec::new(),
            images: Vec::new(),
            ranges: Vec::new(),
        };
        let mut normals = Some(Vec::new());
        let mut noise = Vec::new();
        let mut have_rows = true;
        let mut ends = Vec::new();
        for &(scan, by) in scans {
            by.validate()?;
            let (filtered, of_robot) = filter_and_tell(scan, by.filter)?;
            let kept = filtered.cloud;
            if kept.is_empty() {
                return Err(nothing_left(scan.len(), &filtered.stages));
            }
            // By their rows in the file; the cells of a collision map have none.
            let first_row = all.row_count;
            let row = |i: usize| first_row + filtered.rows.get(i).copied().unwrap_or(i);
            check_points(kept.points.iter().enumerate().map(|(i, p)| (row(i), p)))?;
            let of_scan = moved(by.sensor.covariances(&kept)?, &by.motion, &kept.points);
            all.step = most(all.step, step(&kept.points, &of_scan));
            noise.push(of_scan);
            match (&kept.normals, by.noise.combination) {
                (Some(of_scan), Combination::SurfacePosterior) => {
                    let of_scan = checked(of_scan)?;
                    normals.iter_mut().for_each(|all| all.extend(&of_scan));
                }
                _ => normals = None,
            }
            all.missing = all.missing.max(missing(scan, &filtered.stages));
            all.sensor_doubts.extend(sensor_doubts(scan, by.sensor, &kept.points));
            all.sensor_doubts.extend(robot_doubt(&filtered.stages));
            all.sensor_doubts.extend(padded(&scan.select(&of_robot), by)?);
            // An organised cloud is a depth image: one view, with unseen space behind it.
            if scan.is_image() {
                let points = all.points.len()..all.points.len() + kept.len();
                let pixels = pixels_about(scan, &filtered.rows).unwrap_or(kept.len());
                let (sensor_origin, turn) = (kept.sensor_origin(), *kept.from_sensor().rotation());
                // A robot that no return came from is elsewhere, and makes nothing known.
                let robot = if of_robot.is_empty() { Vec::new() } else { by.filter.robot.clone() };
                all.images.push(Image { sensor_origin, turn, points, pixels, robot });
            } else {
                let (sensor_origin, most) = (scan.sensor_origin(), by.filter.max_range);
                range::add(&mut all.ranges, Range { sensor_origin, most });
            }
            all.origins.extend(kept.sensor_pose.map(|pose| Point3::from(pose.translation())));
            have_rows &= !filtered.rows.is_empty();
            let mut rows = filtered.rows;
            rows.iter_mut().for_each(|row| *row += first_row);
            append(&mut all.rows, rows);
            all.stages.extend(filtered.stages);
            append(&mut all.points, kept.points);
            all.row_count += scan.len();
            ends.push(all.points.len());
        }
        check_for_repeats(&all.points, &ends)?;
        if !have_rows {
            all.rows.clear();
        }
        all.normals = normals;
        all.noise = joined(&noise.iter().collect::<Vec<_>>());
        Ok(all)
    }

    /// Puts others of the same frame behind these, as if all had been given at once.
    pub(super) fn append(&mut self, others: Self) {
        let Self { points, noise, normals, rows, row_count, stages, origins, missing, .. } = others;
        let before = self.points.len();
        let shifted = |image: Image| Image {
            points: before + image.points.start..before + image.points.end,
            ..image
        };
        self.images.extend(others.images.into_iter().map(shifted));
        others.ranges.into_iter().for_each(|other| range::add(&mut self.ranges, other));
        self.noise = joined(&[&self.noise, &noise]);
        self.normals = match (self.normals.take(), normals) {
            (Some(own), Some(others)) => Some(own.into_iter().chain(others).collect()),
            _ => None,
        };
        if self.rows.len() != self.points.len() || rows.len() != points.len() {
            self.rows.clear();
        } else {
            self.rows.extend(rows.iter().map(|row| self.row_count + row));
        }
        self.row_count += row_count;
        self.stages.extend(stages);
        self.origins.extend(origins);
        self.missing = self.missing.max(missing);
        self.step = most(self.step, others.step);
        // One sign of each kind is enough, the last: a camera delivers frames for hours.
        let kind = std::mem::discriminant::<SensorDoubt>;
        let later = &others.sensor_doubts;
        self.sensor_doubts.retain(|doubt| !later.iter().any(|other| kind(other) == kind(doubt)));
        self.sensor_doubts.extend(others.sensor_doubts);
        self.points.extend(points);
    }

    /// Whether the noise of all points is the same, and normals are known, in both or in neither.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let kind = |all: &Self| (all.noise.as_uniform().is_some(), all.normals.is_some());
        kind(self) == kind(other)
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
        Self {
            points: of(&self.points, kept),
            noise,
            normals: self.normals.as_ref().map(|normals| of(normals, kept)),
            rows: if self.rows.is_empty() { Vec::new() } else { of(&self.rows, kept) },
            stages: self.stages.clone(),
            origins: self.origins.clone(),
            sensor_doubts: self.sensor_doubts.clone(),
            images: self.images.clone(),
            ranges: self.ranges.clone(),
            ..*self
        }
    }
}

/// Whether no scan is one that was given before, whose points are as many: given where the points of each end
/// among those of all. Maps of cells may well hold all of a smaller one.
fn check_for_repeats(points: &[Point3], ends: &[usize]) -> Result<(), PrepareError> {
    if ends.len() < 2 {
        return Ok(());
    }
    let mut places = Places::of(points);
    let (mut start, mut counts) = (0, Vec::new());
    for (scan, &end) in (1..).zip(ends) {
        // All are to be seen, not the first alone.
        let own = (start..end).filter(|&index| places.is_first(index)).count();
        if own == 0 && counts.contains(&(end - start)) {
            return Err(PrepareError::RepeatedScan { scan });
        }
        counts.push(end - start);
        start = end;
    }
    Ok(())
}

/// Points taken for the robot of which too many are farther from it than their noise tells.
fn padded(of_robot: &PointCloud, by: Preparation<'_>) -> Result<Option<SensorDoubt>, PrepareError> {
    /// Cables and joints that are a little off leave fewer.
    const MOST: f64 = 0.5;
    if of_robot.is_empty() {
        return Ok(None);
    }
    let noise = moved(by.sensor.covariances(of_robot)?, &by.motion, &of_robot.points);
    let points = of_robot.points.iter().zip(noise.iter().map(Covariance::max_std_at_most));
    let share = beyond_noise(points, &by.filter.robot);
    Ok((share > MOST).then_some(SensorDoubt::Padding { share }))
}

fn most(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    one.into_iter().chain(other).max_by(f64::total_cmp)
}

/// How far apart coordinates kept in single precision are, m, where that is more than any noise.
fn step(points: &[Point3], noise: &SensorNoise) -> Option<f64> {
    let step = single_step(points)?;
    let most = noise.iter().map(Covariance::max_std_at_most).fold(0.0, f64::max);
    (step > most).then_some(step)
}

/// Pixels of the part of an image that these of its rows, in order, are in, with and without return.
fn pixels_about(image: &PointCloud, rows: &[usize]) -> Option<usize> {
    let (width, _) = image.image_size?;
    let lines = (rows.last()? / width).abs_diff(rows.first()? / width) + 1;
    let widen = |(least, most): (usize, usize), row: &usize| {
        (least.min(row % width), most.max(row % width))
    };
    let (least, most) = rows.iter().fold((width, 0), widen);
    Some(lines * (most + 1).saturating_sub(least))
}

/// Puts a list behind another, without a copy of the first that comes.
fn append<T>(all: &mut Vec<T>, mut others: Vec<T>) {
    if all.is_empty() {
        *all = others;
    } else {
        all.append(&mut others);
    }
}

/// The noise of several lists of points, one after the other; stored once where all have the same.
fn joined(parts: &[&SensorNoise]) -> SensorNoise {
    let first = parts.first().and_then(|part| part.as_uniform());
    match first.filter(|first| parts.iter().all(|part| part.as_uniform() == Some(first))) {
        Some(same) => SensorNoise::uniform(*same, parts.iter().map(|part| part.len()).sum()),
        None => parts.iter().flat_map(|part| part.iter()).copied().collect::<Vec<_>>().into(),
    }
}

fn nothing_left(before: usize, stages: &[StageReport]) -> PrepareError {
    let removed: Vec<String> =
        stages.iter().map(|s| format!("{} removed {}", s.stage, s.removed)).collect();
    PrepareError::NothingLeft { before, stages: removed.join(", ") }
}

/// Σ of points that may have moved since they were seen.
fn moved(noise: SensorNoise, motion: &MotionNoise, points: &[Point3]) -> SensorNoise {
    if *motion == MotionNoise::default() {
        return noise;
    }
    let sum = |(seen, place): (&Covariance, &Point3)| seen.sum(&motion.covariance(place));
    SensorNoise::from(noise.iter().zip(points).map(sum).collect::<Vec<_>>())
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
