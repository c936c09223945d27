//! What a cloud is like as a whole: what queries look at before they believe it.

use std::sync::OnceLock;

use cloudtouch_geom::{Point3, PointCloud, Vector3};
use cloudtouch_noise::{Neighborhoods, SensorModel, SensorNoise, typical_spacing_at};

use crate::filter::StageReport;

use super::clumps::{Clumps, clumps};
use super::pinhole::is_misplaced;
use super::scatter::Overstated;

/// Points that spacing, noise and distance are told from, at most.
const SAMPLE: usize = 200;
/// Shells of equal steps of the squared distance from the middle.
const SHELLS: usize = 4096;
/// Points are on a line when none is farther from it than this share of its length: single precision
/// is no better.
const LINE_SHARE: f64 = 1e-6;
/// A camera sees nothing so far off its axis (cosine): 80°.
const BESIDE: f64 = 0.17;
/// A camera with this share of its points beside or behind it stood elsewhere.
const MOST_BESIDE: f64 = 0.01;
/// No sensor has more of its robot before it than this share of what it measures.
const MOST_ROBOT: f64 = 0.5;
/// A structured-light camera sees no farther, m: its fit ends at 3 m, its returns at some 8 m.
const KINECT_RANGE: f64 = 10.0;

/// A sign that the sensor stated did not see the cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SensorDoubt {
    /// So large a share of the points is beside or behind the camera.
    Beside { share: f64 },
    /// The points are farther away than the sensor sees, m.
    Range { median: f64, limit: f64 },
    /// A laser scanner, and the layout of a camera's image.
    Layout,
    /// A camera, and no image.
    NoImage,
    /// No camera at the place stated has such rows and columns.
    Misplaced,
    /// So large a share of the points was taken for the robot itself.
    Robot { share: f64 },
}

/// A cloud as a whole.
#[derive(Debug)]
pub(crate) struct Makeup {
    /// Corners of the box around the points in the local frame, m.
    pub corners: [Point3; 2],
    /// Typical distance of neighbours, m; zero for a single point.
    pub spacing: f64,
    /// Median of the standard deviations, each the largest of its point, m.
    pub std: f64,
    /// Where points lie in clumps.
    pub clumps: Option<Clumps>,
    /// Distinct points.
    pub distinct: usize,
    /// Whether the points span no surface.
    pub is_line: bool,
    /// Share of the rows without return, of a cloud whose layout does not tell where.
    pub missing: f64,
    pub sensor_doubts: Vec<SensorDoubt>,
    /// Noise that is stated and not there; told when first asked for.
    pub overstated: OnceLock<Option<Overstated>>,
}

impl Makeup {
    /// Of the points kept, with their noise and a [sample](sample_of) of them, and the box around them, in the
    /// local frame; and what was told of their scans.
    pub(super) fn new(
        corners: [Point3; 2],
        (kept, noise, sample): (&Neighborhoods, &SensorNoise, &[usize]),
        missing: f64,
        sensor_doubts: Vec<SensorDoubt>,
    ) -> Self {
        let points = kept.points();
        let std = median(sample.iter().map(|&i| noise[i].max_std()));
        Self {
            corners,
            spacing: typical_spacing_at(kept, sample.iter().copied()),
            std,
            clumps: clumps(kept, sample),
            distinct: kept.distinct(),
            is_line: !has_area(points, (corners[1] - corners[0]).norm()) && is_line(points),
            missing,
            sensor_doubts,
            overstated: OnceLock::new(),
        }
    }

    /// Diagonal of the box around the points, m.
    pub(crate) fn size(&self) -> f64 {
        (self.corners[1] - self.corners[0]).norm()
    }
}

/// Share of the rows of a scan without return, where its layout does not tell where they would be.
pub(super) fn missing(scan: &PointCloud, stages: &[StageReport]) -> f64 {
    let stage = stages.iter().find(|s| s.stage == "missing" && !scan.is_image());
    stage.map_or(0.0, |s| s.removed as f64 / s.before.max(1) as f64)
}

/// A scan of which the self filter took most away, where its layout does not tell where that was.
pub(super) fn mostly_robot(scan: &PointCloud, stages: &[StageReport]) -> Option<SensorDoubt> {
    let stage = stages.iter().find(|stage| stage.stage == "robot" && !scan.is_image())?;
    let share = stage.removed as f64 / stage.before.max(1) as f64;
    (share > MOST_ROBOT).then_some(SensorDoubt::Robot { share })
}

/// Some hundred of the points, from all over the cloud.
pub(super) fn sample_of(points: &[Point3]) -> Vec<usize> {
    spread(points, SAMPLE)
}

/// Some of the points, evenly spread by how far they are from the middle of all: probabilities depend on
/// what is told from them, and keep in whatever order and frame the points come.
pub(super) fn spread(points: &[Point3], count: usize) -> Vec<usize> {
    if points.len() <= count {
        return (0..points.len()).collect();
    }
    let sum: Vector3 = points.iter().map(|p| p.coords).sum();
    let middle = Point3::from(sum / points.len() as f64);
    let squared = |p: &Point3| (p - middle).norm_squared();
    // PERF: counted by shells about the middle, only points of those that hold a rank are put in order.
    let outermost = points.iter().map(squared).fold(0.0, f64::max);
    let shell = |squared: f64| ((squared / outermost * SHELLS as f64) as usize).min(SHELLS - 1);
    let mut counts = vec![0_usize; SHELLS];
    points.iter().for_each(|p| counts[shell(squared(p))] += 1);
    // The product fits: an index holds at most 2³² points.
    let rank = |k: usize| ((2 * k + 1) as u64 * points.len() as u64 / (2 * count) as u64) as usize;
    let (mut is_wanted, mut ranks) = (vec![false; SHELLS], Vec::with_capacity(count));
    let (mut at, mut end, mut left_out) = (0, counts[0], 0);
    for rank in (0..count).map(rank) {
        while end <= rank {
            left_out += if is_wanted[at] { 0 } else { counts[at] };
            at += 1;
            end += counts[at];
        }
        is_wanted[at] = true;
        ranks.push(rank - left_out);
    }
    let with_place = points.iter().map(squared).zip(0..);
    let mut by_distance: Vec<(f64, u32)> =
        with_place.filter(|(squared, _)| is_wanted[shell(*squared)]).collect();
    let mut chosen = Vec::with_capacity(count);
    select(&mut by_distance, &ranks, 0, &mut chosen);
    chosen
}

/// The points of these ranks among those of rank `from` on, without sorting what is between.
fn select(slice: &mut [(f64, u32)], ranks: &[usize], from: usize, chosen: &mut Vec<usize>) {
    let middle = ranks.len() / 2;
    let Some(&rank) = ranks.get(middle) else { return };
    let order = |p: &(f64, u32), q: &(f64, u32)| p.0.total_cmp(&q.0);
    let (below, &mut (_, index), above) = slice.select_nth_unstable_by(rank - from, order);
    select(below, &ranks[..middle], from, chosen);
    chosen.push(index as usize);
    select(above, &ranks[middle + 1..], rank + 1, chosen);
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    values.sort_unstable_by(f64::total_cmp);
    values.get(middle).copied().unwrap_or(0.0)
}

/// Whether a few of the points make a triangle that no line passes so closely, the cloud being of such a size:
/// then it is none, and the rest need no look.
fn has_area(points: &[Point3], size: f64) -> bool {
    let step = points.len().div_ceil(SAMPLE).max(1);
    let some: Vec<&Point3> = points.iter().step_by(step).collect();
    let far =
        |from: &Point3| some.iter().map(|p| *p - from).max_by(|p, q| p.norm().total_cmp(&q.norm()));
    let Some((first, side)) = some.first().and_then(|first| Some((*first, far(first)?))) else {
        return false;
    };
    // Of points within ε of a line none has a product above 6 ε times the longest side.
    let area = some.iter().map(|p| (*p - first).cross(&side).norm()).fold(0.0, f64::max);
    area > 8.0 * LINE_SHARE * size * side.norm()
}

/// Whether the points spread along one direction only, or along none.
fn is_line(points: &[Point3]) -> bool {
    let Some(first) = points.first() else { return true };
    let far = |from: &Point3| {
        let farther = |p: &Point3, q: &Point3| {
            let [p, q] = [p, q].map(|r| (r - from).norm_squared());
            p.total_cmp(&q)
        };
        points.iter().copied().max_by(farther).unwrap_or(*first)
    };
    let end = far(first);
    let Some(along) = (far(&end) - end).try_normalize(0.0) else { return true };
    let length = (far(&end) - end).norm();
    points.iter().all(|p| (p - end).cross(&along).norm() <= LINE_SHARE * length)
}

/// Whether the sensor can have seen the points that were kept of a scan.
pub(super) fn sensor_doubts(
    cloud: &PointCloud,
    sensor: &SensorModel,
    points: &[Point3],
) -> Vec<SensorDoubt> {
    let place = cloud.sensor_origin();
    let rays = || points.iter().map(|p| p - place);
    let mut doubts = Vec::new();
    match sensor {
        SensorModel::Kinect | SensorModel::Stereo { .. } => {
            let share = |axis: Vector3| {
                let is_beside = |ray: &Vector3| ray.dot(&axis) < BESIDE * ray.norm();
                rays().filter(is_beside).count() as f64 / points.len().max(1) as f64
            };
            // The turn that a file states may be one that its points are not in.
            let stated = cloud.from_sensor().transform_vector(&Vector3::z());
            let share = share(stated).min(share(Vector3::z()));
            if share > MOST_BESIDE {
                doubts.push(SensorDoubt::Beside { share });
            }
            if !cloud.is_image() {
                doubts.push(SensorDoubt::NoImage);
            }
        }
        SensorModel::Lidar { .. } if cloud.is_image() => {
            let forward = rays().filter_map(|ray| ray.try_normalize(0.0)).sum::<Vector3>();
            let forward = forward.try_normalize(0.0).unwrap_or_else(Vector3::z);
            if rays().all(|ray| ray.dot(&forward) >= BESIDE * ray.norm()) {
                doubts.push(SensorDoubt::Layout);
            }
        }
        _ => {}
    }
    let is_laser = matches!(sensor, SensorModel::Lidar { .. });
    if doubts.is_empty() && !is_laser && cloud.is_image() && is_misplaced(cloud, &place) {
        doubts.push(SensorDoubt::Misplaced);
    }
    if *sensor == SensorModel::Kinect {
        let step = points.len().div_ceil(SAMPLE).max(1);
        let median = median(rays().step_by(step).map(|ray| ray.norm()));
        if median > KINECT_RANGE {
            doubts.push(SensorDoubt::Range { median, limit: KINECT_RANGE });
        }
    }
    doubts
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn points_chosen_by_shells_are_those_of_the_sorted_cloud(
            coordinates in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 8..2000),
            count in 1..200_usize,
            far in prop::option::of(1.0..1e6_f64),
        ) {
            let mut points: Vec<Point3> = coordinates.into_iter().map(Point3::from).collect();
            // One far off leaves all others in a shell.
            points.extend(far.map(|x| Point3::new(x, 0.0, 0.0)));
            let chosen = spread(&points, count);
            let middle: Vector3 = points.iter().map(|p| p.coords).sum::<Vector3>() / points.len() as f64;
            let squared = |i: &usize| (points[*i].coords - middle).norm_squared();
            let mut sorted: Vec<usize> = (0..points.len()).collect();
            sorted.sort_by(|p, q| squared(p).total_cmp(&squared(q)));
            let rank = |k: usize| (2 * k + 1) * points.len() / (2 * count);
            if points.len() > count {
                let expected: Vec<usize> = (0..count).map(|k| sorted[rank(k)]).collect();
                prop_assert_eq!(chosen, expected);
            } else {
                prop_assert_eq!(chosen, (0..points.len()).collect::<Vec<_>>());
            }
        }
    }
}
