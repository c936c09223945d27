//! What a cloud is like as a whole: what queries look at before they believe it.

mod bearing;
pub(super) mod clumps;
pub(super) mod copies;
pub(super) mod layout;
pub(super) mod median;
mod panorama;
mod pinhole;
pub(super) mod scatter;
pub(super) mod spread;

use std::sync::OnceLock;

use cloudtouch_geom::{Point3, PointCloud, Vector3};
use cloudtouch_noise::{Neighborhoods, SensorModel, SensorNoise, typical_of_spacings};

use crate::cloud::makeup::clumps::{Clumps, clumps};
use crate::cloud::makeup::layout::{BESIDE, Layout};
use crate::cloud::makeup::median::median;
use crate::cloud::makeup::scatter::{Scatter, few_of};
use crate::cloud::makeup::spread::{SAMPLE, Sample};
use crate::filter::StageReport;
use crate::some::some_of;

/// Points are on a line when none is farther from it than this share of its length: single precision
/// is no better.
const LINE_SHARE: f64 = 1e-6;
/// A camera with this share of its points beside or behind it stood elsewhere.
const MOST_BESIDE: f64 = 0.01;
/// No sensor has more of its robot before it than this share of what it measures.
const MOST_ROBOT: f64 = 0.5;
/// One point of so many may be a stray, ...
const ONE_STRAY_OF: usize = 50;
/// ... if the cloud is so many times as large as without them.
const FAR_LARGER: f64 = 4.0;
/// A structured-light camera sees no farther, m: its fit ends at 3 m, its returns at some 8 m.
const KINECT_RANGE: f64 = 10.0;

/// With more points behind the camera than this, the turn stated for it is not believed
/// ([`position_noise`](cloudtouch_noise::position_noise)).
const MOST_BEHIND: f64 = 0.5;

/// A sign that the sensor stated did not see the cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum SensorDoubt {
    /// So large a share of the points is beside or behind the camera.
    Beside { share: f64 },
    /// So large a share of the points is behind the camera by the turn stated for it, which is not believed.
    Turn { share: f64 },
    /// The points are farther away than the sensor sees, m.
    Range { median: f64, limit: f64 },
    /// A laser scanner, and the layout of a camera's image.
    Layout,
    /// A camera, or a laser scanner at some place, and no image.
    NoImage,
    /// No camera, or no laser scanner, at the place stated has such rows and columns.
    Misplaced,
    /// So large a share of the points was taken for the robot itself.
    Robot { share: f64 },
    /// None was.
    NoRobot,
    /// So large a share of the points taken for the robot is farther from it than their noise tells.
    Padding { share: f64 },
}

/// A cloud as a whole.
#[derive(Debug)]
pub(crate) struct Makeup {
    /// Corners of the box around the points in the local frame, m.
    pub corners: [Point3; 2],
    /// How large it is but for a few far strays, m.
    pub core: f64,
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
    /// How far apart coordinates are, m, where that is more than the noise.
    pub step: Option<f64>,
    pub sensor_doubts: Vec<SensorDoubt>,
    /// Some of the points, from all over it, ...
    pub places: Vec<usize>,
    /// ... and what points scatter by there; told when first asked for.
    pub scatter: OnceLock<Option<Scatter>>,
}

impl Makeup {
    /// Of the points kept, with their noise and a [sample](spread::sample_of) of them, and the box around them,
    /// in the local frame; and what was told of their scans.
    pub(super) fn new(
        corners: [Point3; 2],
        (kept, noise, sample): (&Neighborhoods, &SensorNoise, &Sample),
        (missing, step): (f64, Option<f64>),
        sensor_doubts: Vec<SensorDoubt>,
    ) -> Self {
        let points = kept.points();
        let std = median(sample.indices.iter().map(|&i| noise[i].max_std()));
        Self {
            corners,
            core: core((corners[1] - corners[0]).norm(), points, &sample.indices),
            spacing: typical_of_spacings(sample.spacings(kept)),
            std,
            clumps: clumps(kept, &sample.indices),
            distinct: kept.distinct(),
            is_line: !has_area(points, (corners[1] - corners[0]).norm()) && is_line(points),
            missing,
            step,
            sensor_doubts,
            places: few_of(&sample.indices),
            scatter: OnceLock::new(),
        }
    }

    /// Diagonal of the box around the points, m.
    pub(crate) fn size(&self) -> f64 {
        (self.corners[1] - self.corners[0]).norm()
    }
}

/// Size of the box around a cloud, m, or of the ball about the median of its sample that holds all but one in fifty, if
/// that is far smaller: stereo cameras deliver returns hundreds of metres away where nothing is.
fn core(size: f64, points: &[Point3], sample: &[usize]) -> f64 {
    let middle = [0, 1, 2].map(|axis| median(sample.iter().map(|&i| points[i][axis])));
    let mut away: Vec<f64> =
        sample.iter().map(|&i| (points[i] - Point3::from(middle)).norm()).collect();
    away.sort_unstable_by(f64::total_cmp);
    let held = away.len().saturating_sub(1 + away.len() / ONE_STRAY_OF);
    let core = away.get(held).map_or(size, |radius| 2.0 * radius);
    if size > FAR_LARGER * core && core > 0.0 { core } else { size }
}

/// Share of the rows of a scan without return, where its layout does not tell where they would be.
pub(super) fn missing(scan: &PointCloud, stages: &[StageReport]) -> f64 {
    let stage = stages.iter().find(|s| s.stage == "missing" && !scan.is_image());
    stage.map_or(0.0, |s| s.removed as f64 / s.before.max(1) as f64)
}

/// A scan of which the self filter took most away, or nothing.
pub(super) fn robot_doubt(stages: &[StageReport]) -> Option<SensorDoubt> {
    let stage = stages.iter().find(|stage| stage.stage == "robot")?;
    let share = stage.removed as f64 / stage.before.max(1) as f64;
    if stage.removed == 0 {
        Some(SensorDoubt::NoRobot)
    } else {
        (share > MOST_ROBOT).then_some(SensorDoubt::Robot { share })
    }
}

/// Whether a few of the points make a triangle that no line passes so closely, the cloud being of such a size:
/// then it is none, and the rest need no look.
fn has_area(points: &[Point3], size: f64) -> bool {
    let some: Vec<&Point3> = some_of(points.len(), SAMPLE).map(|index| &points[index]).collect();
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

/// Whether the sensor can have seen the points that were kept of a scan, given the layout of one that is an image.
pub(super) fn sensor_doubts(
    cloud: &PointCloud,
    sensor: &SensorModel,
    points: &[Point3],
    layout: Option<Layout>,
) -> Vec<SensorDoubt> {
    let place = cloud.sensor_origin();
    let rays = || points.iter().map(|p| p - place);
    let mut doubts = Vec::new();
    let is_camera = sensor.is_camera();
    match sensor {
        _ if is_camera => {
            let share = |axis: Vector3| {
                let is_beside = |ray: &Vector3| ray.dot(&axis) < BESIDE * ray.norm();
                rays().filter(is_beside).count() as f64 / points.len().max(1) as f64
            };
            // The turn that a file states may be one that its points are not in.
            let stated = cloud.from_sensor().transform_vector(&Vector3::z());
            let share = share(stated).min(share(Vector3::z()));
            let behind = rays().filter(|ray| ray.dot(&stated) <= 0.0).count() as f64;
            let behind = behind / points.len().max(1) as f64;
            if share > MOST_BESIDE {
                doubts.push(SensorDoubt::Beside { share });
            } else if behind > MOST_BEHIND {
                doubts.push(SensorDoubt::Turn { share: behind });
            }
            if !cloud.is_image() {
                doubts.push(SensorDoubt::NoImage);
            }
        }
        SensorModel::Lidar { .. } if layout.is_some_and(|layout| layout.is_camera()) => {
            doubts.push(SensorDoubt::Layout);
        }
        // Scans that were merged have no place.
        SensorModel::Lidar { .. } if !cloud.is_image() && cloud.sensor_pose.is_some() => {
            doubts.push(SensorDoubt::NoImage);
        }
        _ => {}
    }
    // What lies beside where a camera looks is doubted by that already.
    let is_beside = doubts.iter().any(|of| matches!(of, SensorDoubt::Beside { .. }));
    if layout.is_some_and(|layout| layout.is_misplaced) && !is_beside {
        doubts.push(SensorDoubt::Misplaced);
    }
    if *sensor == SensorModel::Kinect {
        let some = some_of(points.len(), SAMPLE).map(|index| (points[index] - place).norm());
        let median = median(some);
        if median > KINECT_RANGE {
            doubts.push(SensorDoubt::Range { median, limit: KINECT_RANGE });
        }
    }
    doubts
}
