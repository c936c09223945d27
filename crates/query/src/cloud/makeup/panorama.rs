//! Whether the rows and columns of a laser scan are those of a scanner at the place stated for it.

use cloudtouch_geom::{Matrix3, Point3, PointCloud, Vector3};
use nalgebra::SymmetricEigen;

use super::median::median;
use crate::filter::is_return_to;

/// Lines that are looked at, at most, and returns of each.
const LINES: usize = 50;
const OF_A_LINE: usize = 40;
/// Returns for an answer, at least.
const LEAST: usize = 50;
/// A return this far from the cone of its line (a difference of cosines, rad across) is not one of it: a
/// tenth of a metre at three, and many times what a scanner's mirror or the boards of its lasers are off.
const OFF: f64 = 0.03;
/// So large a share of the returns may be: those measured while a scanner moved, and mixed ones.
const MOST_OFF: f64 = 0.2;

/// How the lines of a panorama fit on cones.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cones {
    /// How far returns are from what a scanner at the place asked about sees along its lines, however it stood, as half
    /// of them are (rad); infinite where it cannot have taken the image.
    pub misfit: f64,
    /// How far apart lines are in the mean, as a difference of cosines.
    pub apart: f64,
    /// Their axis, of either sign.
    pub axis: Vector3,
    /// Whether they are the rows of the image, or its columns.
    pub are_rows: bool,
}

/// Of rows or columns, whichever fit better; `None` where too little was measured to tell.
///
/// A scanner that turns about an axis sees along a line of its image a cone about that axis: all around at one
/// elevation, be that a row or a column. One whose fan of beams nods does so too, about the axis of its
/// nodding. From another place what is near leaves the cone of what is far.
pub(super) fn fit(image: &PointCloud, place: &Point3) -> Option<Cones> {
    let (width, height) = image.image_size?;
    let rows = lines(image, place, (height, width), |row, column| row * width + column);
    let columns = lines(image, place, (width, height), |column, row| row * width + column);
    let [rows, columns] = [cones(&rows, height)?, cones(&columns, width)?];
    Some(match columns.misfit < rows.misfit {
        true => Cones { are_rows: false, ..columns },
        false => rows,
    })
}

/// Unit vectors to the returns of some lines, of `size.0` that have `size.1` pixels each.
fn lines(
    image: &PointCloud,
    place: &Point3,
    size: (usize, usize),
    index: impl Fn(usize, usize) -> usize,
) -> Vec<Vec<Vector3>> {
    let seen = |line: usize| -> Vec<Vector3> {
        let returns = (0..size.1).map(|k| image.points[index(line, k)]);
        let returns: Vec<_> = returns.filter(|p| is_return_to(place, p)).collect();
        let some = returns.iter().step_by(returns.len().div_ceil(OF_A_LINE).max(1));
        some.filter_map(|p| (p - place).try_normalize(0.0)).collect()
    };
    (0..size.0).step_by(size.0.div_ceil(LINES).max(1)).map(seen).collect()
}

/// Of some of so many lines.
fn cones(lines: &[Vec<Vector3>], all: usize) -> Option<Cones> {
    let count: usize = lines.iter().map(Vec::len).sum();
    if count < LEAST {
        return None;
    }
    let off = || lines.iter().flat_map(|line| from_mean(line));
    // Along the axis of the cones the directions of a line differ least.
    let scatter = off().map(|d| d * d.transpose()).sum::<Matrix3>();
    let eigen = SymmetricEigen::try_new(scatter, f64::EPSILON, 1000)?;
    let axis: Vector3 = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    let off: Vec<f64> = off().map(|d| d.dot(&axis).abs()).collect();
    let is_off = off.iter().filter(|off| **off > OFF).count();
    let is_none = is_off as f64 > MOST_OFF * count as f64;
    let misfit = if is_none { f64::INFINITY } else { median(off.into_iter()) };
    let middles = lines.iter().filter(|line| !line.is_empty()).map(|line| mean(line).dot(&axis));
    let (low, high) = middles
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| (at.min(low), at.max(high)));
    let apart = (high - low) / all.saturating_sub(1).max(1) as f64;
    Some(Cones { misfit, apart, axis, are_rows: true })
}

/// Of each direction of a line what the mean of the line lacks.
fn from_mean(line: &[Vector3]) -> impl Iterator<Item = Vector3> + '_ {
    let mean = mean(line);
    line.iter().map(move |direction| direction - mean)
}

fn mean(line: &[Vector3]) -> Vector3 {
    line.iter().sum::<Vector3>() / line.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use cloudtouch_geom::Pose;

    use super::*;

    /// How far a ray from (0, 0, 1.5) goes in a room of 8 m by 6 m by 3 m with a pillar.
    fn range(ray: &Vector3) -> f64 {
        let reach = [4.0, 3.0, 1.5];
        let walls = (0..3).map(|k| reach[k] / ray[k].abs()).fold(f64::INFINITY, f64::min);
        let bearing = ray.y.atan2(ray.x);
        let flat = ray.xy().norm();
        if (bearing - 0.4).abs() < 0.3 { walls.min(1.2 / flat) } else { walls }
    }

    /// Rings of a turning scanner, as rows, or a fan that nods about y.
    fn scan(beams: usize, steps: usize, nods: bool) -> PointCloud {
        let ray = |beam: usize, step: usize| {
            let up = -0.5 + beam as f64 / beams as f64;
            let round = TAU * step as f64 / steps as f64;
            if nods {
                // The beam in its fan from side to side, and the fan's nod up to right behind.
                let (side, nod) = (2.4 * up, 0.5 * round);
                Vector3::new(side.cos() * nod.cos(), side.sin(), side.cos() * nod.sin())
            } else {
                Vector3::new(up.cos() * round.cos(), up.cos() * round.sin(), up.sin())
            }
        };
        let pixels = (0..beams * steps).map(|i| ray(i / steps, i % steps));
        let points = pixels.map(|ray| Point3::from(ray * range(&ray))).collect();
        PointCloud { image_size: Some((steps, beams)), ..PointCloud::from_points(points) }
    }

    fn turned(image: &PointCloud) -> PointCloud {
        let (width, height) = image.image_size.unwrap();
        let points =
            (0..width * height).map(|i| image.points[i % height * width + i / height]).collect();
        PointCloud { points, image_size: Some((height, width)), ..image.clone() }
    }

    fn moved(image: &PointCloud, pose: &Pose) -> PointCloud {
        let points = image.points.iter().map(|p| pose.transform_point(p)).collect();
        PointCloud { points, ..image.clone() }
    }

    fn is_misplaced(image: &PointCloud, place: &Point3) -> bool {
        fit(image, place).is_some_and(|cones| cones.misfit == f64::INFINITY)
    }

    #[test]
    fn a_scanner_is_where_it_was_and_nowhere_else() {
        let rings = scan(16, 900, false);
        for image in [turned(&rings), scan(200, 90, true), rings] {
            for turn in [[0.0; 3], [0.3, -1.0, 2.5]] {
                let pose = Pose::from_translation_rpy(Vector3::new(3.0, -1.0, 1.2), turn);
                let there = Point3::from(pose.translation());
                let image = moved(&image, &pose);
                assert!(!is_misplaced(&image, &there), "{turn:?}");
                assert!(is_misplaced(&image, &Point3::origin()), "{turn:?}");
                for away in [Vector3::new(0.5, 0.0, 0.0), Vector3::new(0.0, -0.3, 0.4)] {
                    assert!(is_misplaced(&image, &(there + away)), "{turn:?} {away}");
                }
            }
        }
    }

    #[test]
    fn holes_and_a_few_centimetres_are_no_matter() {
        let rings = scan(16, 900, false);
        let hole = |(k, p): (usize, &Point3)| match k % 7 {
            0 => p * f64::NAN,
            // What some drivers write for none.
            1 | 2 => Point3::new(3.4e38, 3.4e38, 3.4e38),
            _ => *p,
        };
        let points = rings.points.iter().enumerate().map(hole).collect();
        let holed = PointCloud { points, ..rings };
        assert!(!is_misplaced(&holed, &Point3::new(0.03, 0.0, 0.0)));
        assert!(is_misplaced(&holed, &Point3::new(0.5, 0.0, 0.0)));
    }

    #[test]
    fn too_few_returns_tell_nothing() {
        let rings = scan(4, 10, false);
        assert!(fit(&rings, &Point3::new(2.0, 0.0, 0.0)).is_none());
    }
}
