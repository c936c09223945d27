//! A body with the surface of the other all around it: nothing near says that it touches, and nothing
//! says on which side of that surface it is.

use cloudtouch_geom::{Point3, Pose, Vector3};

use crate::cloud::Prepared;
use crate::shape::Shape;

/// Points that stand for the surface around, at most.
const MOST_POINTS: usize = 4096;
/// Directions are told apart by squares on the faces of a cube, so many a side at most.
const MOST_SQUARES: usize = 4;
/// So many points are expected to fall in each square of a closed surface.
const POINTS_PER_SQUARE: f64 = 8.0;
/// With this share of the squares filled there is no way out.
const CLOSED: f64 = 0.97;

/// A way that keeps so many spacings from every point passes no surface.
const SURFACE_SPACINGS: f64 = 1.0;

/// Whether the surface of one cloud is all around the other, so that neither knows whether the space
/// between them is empty. Where a sensor's place is known and it looks at the inner one past no
/// surface, that space was seen to be.
pub(crate) fn is_enclosed(a: Shape<'_>, b: Shape<'_>, a_from_b: &Pose) -> bool {
    let (Shape::Cloud(a), Shape::Cloud(b)) = (a, b) else { return false };
    let of = |cloud: &Prepared| {
        let obb = cloud.tree().root().map(|root| *root.obb());
        obb.map_or((Point3::origin(), 0.0), |obb| (obb.centre, obb.radius()))
    };
    let ((middle_of_a, radius_of_a), (middle_of_b, radius_of_b)) = (of(a), of(b));
    // The larger one cannot be within the smaller.
    if radius_of_a >= radius_of_b {
        surrounds(a, &a_from_b.transform_point(&middle_of_b))
    } else {
        surrounds(b, &a_from_b.inverse().transform_point(&middle_of_a))
    }
}

fn surrounds(cloud: &Prepared, place: &Point3) -> bool {
    let Some(root) = cloud.tree().root() else { return false };
    if !root.obb().contains(place) {
        return false;
    }
    let points = cloud.points();
    let step = points.len().div_ceil(MOST_POINTS).max(1);
    let count = points.len().div_ceil(step);
    let squares = (count as f64 / (6.0 * POINTS_PER_SQUARE)).sqrt().floor() as usize;
    let squares = squares.clamp(1, MOST_SQUARES);
    let mut is_filled = vec![false; 6 * squares * squares];
    for point in points.iter().step_by(step) {
        if let Some(square) = square_of(&(point - place), squares) {
            is_filled[square] = true;
        }
    }
    let filled = is_filled.iter().filter(|filled| **filled).count();
    filled as f64 >= CLOSED * is_filled.len() as f64
        && !cloud.sensor_origins().iter().any(|sensor| sees(cloud, sensor, place))
}

/// Which square of the cube around the origin a direction passes; `None` for none.
fn square_of(direction: &Vector3, squares: usize) -> Option<usize> {
    let axis = direction.iamax();
    let size = direction[axis].abs();
    if size.is_nan() || size == 0.0 {
        return None;
    }
    let along = |k: usize| {
        let share = 0.5 * (direction[(axis + k) % 3] / size + 1.0);
        ((share * squares as f64) as usize).min(squares - 1)
    };
    let face = 2 * axis + usize::from(direction[axis] < 0.0);
    Some((face * squares + along(1)) * squares + along(2))
}

/// Whether no point of the cloud is near the way from its sensor to a place.
fn sees(cloud: &Prepared, sensor: &Point3, place: &Point3) -> bool {
    let way = place - sensor;
    let length = way.norm();
    let spacing = cloud.makeup().spacing;
    cloud.points().iter().all(|point| {
        let offset = point - sensor;
        let along = offset.dot(&way) / length.max(f64::MIN_POSITIVE);
        let aside = (offset.norm_squared() - along * along).max(0.0).sqrt();
        let is_between = along > 0.0 && along < length;
        !is_between || aside > SURFACE_SPACINGS * spacing
    })
}
