//! A scan with the rows and columns of an image.

use std::ops::Range;
use std::sync::Arc;

use cloudtouch_geom::{Point3, PointCloud, Vector3};
use nalgebra::UnitQuaternion;

use crate::filter::SelfMesh;

/// A scan that is a depth image.
#[derive(Debug, Clone)]
pub(in crate::cloud) struct Image {
    /// Where the sensor stood, m, and which way it looked: x right, y down for a camera, z up for a scanner.
    pub sensor_origin: Point3,
    pub turn: UnitQuaternion<f64>,
    /// Which points are its.
    pub points: Range<usize>,
    /// Of a laser scanner, though all may lie ahead, the bearing about z in its frame where those of its view begin, rad.
    pub scanner: Option<f64>,
    /// How many columns and rows of pixels are where these are, those without return too.
    pub pixels: [usize; 2],
    /// The links of the robot that were taken out of it.
    pub robot: Vec<SelfMesh>,
    /// Rays of returns that were left out for their range, up to where they say that there is nothing, m.
    pub beyond: Arc<[Vector3]>,
    /// Returns that are none of the points.
    pub others: Arc<[OtherReturn]>,
    /// Whether it is of the scene as it was after all images before it.
    pub is_later: bool,
}

/// A return that is no point of the cloud and still says how far was seen.
#[derive(Debug, Clone, Copy)]
pub(in crate::cloud) struct OtherReturn {
    /// From the sensor to it, m.
    pub ray: Vector3,
    /// An upper bound of its standard deviations, m.
    pub std: f64,
}

impl Image {
    /// Of an organised cloud, a scanner's or not ([`Self::scanner`]), given what was kept of it, from which rows (none of a
    /// collision map), the links that were taken out, and the rows of what was too far, with their rays, and of others
    /// that are no points.
    pub(in crate::cloud) fn of(
        (scan, scanner): (&PointCloud, Option<f64>),
        (kept, rows): (&PointCloud, &[usize]),
        robot: Vec<SelfMesh>,
        beyond: &[(usize, Vector3)],
        others: &[(usize, OtherReturn)],
    ) -> Self {
        let looked_at = (rows.iter())
            .chain(beyond.iter().map(|(row, _)| row))
            .chain(others.iter().map(|(row, _)| row));
        Self {
            sensor_origin: kept.sensor_origin(),
            turn: *kept.from_sensor().rotation(),
            points: 0..rows.len(),
            scanner,
            pixels: pixels_about(scan, looked_at).unwrap_or([kept.len(), 1]),
            robot,
            beyond: beyond.iter().map(|(_, ray)| *ray).collect(),
            others: others.iter().map(|(_, other)| *other).collect(),
            is_later: false,
        }
    }
}

/// Columns and rows of the part of an image that these of its pixels are in, with and without return.
fn pixels_about<'a>(
    image: &PointCloud,
    mut rows: impl Iterator<Item = &'a usize>,
) -> Option<[usize; 2]> {
    let (width, _) = image.image_size?;
    let at = |row: &usize| [row / width, row % width];
    let first = at(rows.next()?);
    let widen = |[low, high]: [[usize; 2]; 2], row: &usize| {
        let at = at(row);
        [[0, 1].map(|k| low[k].min(at[k])), [0, 1].map(|k| high[k].max(at[k]))]
    };
    let [low, high] = rows.fold([first; 2], widen);
    Some([1, 0].map(|k| high[k] - low[k] + 1))
}
