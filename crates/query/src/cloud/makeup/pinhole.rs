//! Whether the rows and columns of a depth image are those of a camera at the place stated for it.

use cloudtouch_geom::{Matrix3, Point3, PointCloud, Vector3};
use nalgebra::{SMatrix, SVector, SymmetricEigen};

use super::median::median;
use crate::filter::is_return_to;
use crate::some::some_of;

/// Pixels that are looked at, at most, and at least for an answer.
const SAMPLE: usize = 1000;
const LEAST: usize = 50;
/// A pixel this far from where a camera has it, in halves of the image's width, is not one of it: some ten
/// of 640 columns, more than lenses bend.
const OFF: f64 = 0.03;
/// So large a share of the pixels may be.
const MOST_OFF: f64 = 0.2;
/// A camera's rows and columns are at right angles, to this cosine, ...
const ASLANT: f64 = 0.2;
/// ... and of like width, to this factor: columns may have been left out.
const UNLIKE: f64 = 3.5;

/// A pixel, in halves of the image's width from its middle, and the unit vector to what it measured.
type Seen = (Vector3, Vector3);

/// How far the pixels of a depth image are from where a camera at this place has them, wherever it looked, as half of
/// them are (rad); infinite where it cannot have taken it, `None` where too little was measured to tell.
///
/// Of a camera the direction of a pixel is M (u, v, 1) with the columns of M for u and v at right angles and
/// equally long. From another place what is near moves against what is far, and the best M fits badly; if
/// all is on one plane it fits, but aslant.
pub(super) fn misfit(image: &PointCloud, place: &Point3) -> Option<f64> {
    let seen = seen(image, place);
    if seen.len() < LEAST {
        return None;
    }
    let camera = fitted(&seen)?;
    let [u, v] = [0, 1].map(|k| Vector3::from(camera.column(k)));
    let (width, height) = (u.norm(), v.norm());
    let is_aslant = u.dot(&v).abs() > ASLANT * width * height;
    let is_stretched = width > UNLIKE * height || height > UNLIKE * width;
    let is_off = |(pixel, direction): &&Seen| {
        let towards = camera * pixel;
        // How far its direction moves by one half of the width.
        let step = u.cross(&towards).norm().max(v.cross(&towards).norm());
        direction.cross(&towards).norm() * towards.norm() > OFF * step
            || direction.dot(&towards) <= 0.0
    };
    let off = seen.iter().filter(is_off).count();
    if is_aslant || is_stretched || off as f64 > MOST_OFF * seen.len() as f64 {
        return Some(f64::INFINITY);
    }
    let angle = |(pixel, direction): &Seen| direction.angle(&(camera * pixel));
    Some(median(seen.iter().map(angle)))
}

fn seen(image: &PointCloud, place: &Point3) -> Vec<Seen> {
    let Some((width, height)) = image.image_size else { return Vec::new() };
    let returns = image.points.iter().enumerate().filter(|(_, p)| is_return_to(place, p));
    let returns: Vec<(usize, &Point3)> = returns.collect();
    let half = 0.5 * width as f64;
    let pixel = |index: usize| {
        let (row, column) = (index / width, index % width);
        Vector3::new(column as f64 / half - 1.0, (row as f64 - 0.5 * height as f64) / half, 1.0)
    };
    let some = some_of(returns.len(), SAMPLE).map(|k| returns[k]);
    some.filter_map(|(index, p)| Some((pixel(index), (p - place).try_normalize(0.0)?))).collect()
}

/// The M for which the sum of (direction × M pixel)² is least, pixels looking ahead; `None` where that has no
/// answer.
fn fitted(seen: &[Seen]) -> Option<Matrix3> {
    let mut squares = SMatrix::<f64, 9, 9>::zeros();
    for (pixel, direction) in seen {
        let across = direction.cross_matrix();
        for row in 0..3 {
            let terms = SVector::<f64, 9>::from_fn(|k, _| across[(row, k % 3)] * pixel[k / 3]);
            squares += terms * terms.transpose();
        }
    }
    let eigen = SymmetricEigen::try_new(squares, f64::EPSILON, 1000)?;
    let best = eigen.eigenvectors.column(eigen.eigenvalues.imin());
    let camera = Matrix3::from_column_slice(best.as_slice());
    let ahead = seen.iter().filter(|(pixel, direction)| direction.dot(&(camera * pixel)) > 0.0);
    Some(if 2 * ahead.count() < seen.len() { -camera } else { camera })
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;
    use cloudtouch_testkit::camera::DepthCamera;
    use cloudtouch_testkit::exact::ExactMesh;
    use cloudtouch_testkit::scene;

    use super::*;

    fn at(x: f64, y: f64, z: f64) -> Pose {
        Pose::from_translation(Vector3::new(x, y, z))
    }

    fn moved(image: &PointCloud, pose: &Pose) -> PointCloud {
        let points = image.points.iter().map(|p| pose.transform_point(p)).collect();
        PointCloud { points, ..image.clone() }
    }

    /// A wall aslant, alone and with a block before it.
    fn images() -> [PointCloud; 2] {
        let aslant = Pose::from_translation_rpy(Vector3::new(0.0, 0.0, 2.5), [0.5, 0.4, 0.0]);
        let wall = ExactMesh::new(&scene::moved(&scene::plane_patch(9.0), &aslant));
        let block = ExactMesh::new(&scene::moved(&scene::cuboid([0.5; 3]), &at(0.1, 0.0, 1.3)));
        let camera = DepthCamera::default();
        [vec![&wall], vec![&wall, &block]].map(|all| camera.scan(&all, &Pose::identity(), 5))
    }

    fn is_misplaced(image: &PointCloud, place: &Point3) -> bool {
        misfit(image, place) == Some(f64::INFINITY)
    }

    #[test]
    fn a_camera_is_where_it_was_and_nowhere_else() {
        let [wall, block] = images();
        for turn in [[0.0; 3], [0.3, -1.0, 2.5], [-1.5, 0.2, 0.7]] {
            let pose = Pose::from_translation_rpy(Vector3::new(3.0, -1.0, 1.2), turn);
            let there = Point3::from(pose.translation());
            let [wall, block] = [&wall, &block].map(|image| moved(image, &pose));
            for image in [&wall, &block] {
                assert!(!is_misplaced(image, &there), "{turn:?}");
                assert!(is_misplaced(image, &Point3::origin()), "{turn:?}");
            }
            for away in [Vector3::new(0.5, 0.0, 0.0), Vector3::new(0.0, -0.6, 0.4)] {
                assert!(is_misplaced(&block, &(there + away)), "{turn:?} {away}");
            }
        }
    }

    #[test]
    fn columns_left_out_and_holes_are_no_matter() {
        let [_, image] = images();
        let (width, height) = image.image_size.unwrap();
        let kept: Vec<usize> =
            (0..width * height).filter(|i| (i % width).is_multiple_of(2)).collect();
        let points = kept.iter().map(|&i| image.points[i]);
        let holed = points.enumerate().map(|(k, p)| match k % 7 {
            0 => p * f64::NAN,
            // What some drivers write for none.
            1 | 2 => Point3::new(3.4e38, 3.4e38, 3.4e38),
            _ => p,
        });
        let size = Some((width.div_ceil(2), height));
        let image = PointCloud { image_size: size, ..PointCloud::from_points(holed.collect()) };
        assert!(!is_misplaced(&image, &Point3::origin()));
        assert!(is_misplaced(&image, &Point3::new(0.5, 0.0, 0.0)));
    }

    #[test]
    fn too_few_returns_tell_nothing() {
        let [image, _] = images();
        let points = image.points[..40].to_vec();
        let few = PointCloud { image_size: Some((8, 5)), ..PointCloud::from_points(points) };
        assert_eq!(misfit(&few, &Point3::new(5.0, 0.0, 0.0)), None);
    }
}
