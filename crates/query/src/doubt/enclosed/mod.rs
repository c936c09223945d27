//! A body with the surface of the other all around it: nothing near says that it touches, and nothing
//! says on which side of that surface it is.

mod open_side;
mod sight;
mod squares;

use cloudtouch_geom::{Point3, Pose};

use crate::cloud::Prepared;
use crate::mesh::Mesh;
use crate::shape::Shape;

use open_side::has_open_side;
use sight::sees;
use squares::{MOST_SQUARES, Squares};

/// Points that stand for the surface around, at most.
const MOST_POINTS: usize = 4096;
/// So many points are expected to fall in each square of a closed surface.
const POINTS_PER_SQUARE: f64 = 8.0;
/// From so many a side on a square is too small for a way out.
const SMALL_SQUARES: usize = 3;
/// With this share of the squares filled there is no way out.
const CLOSED: f64 = 0.97;

/// Whether the surface of a cloud is all around the other body, so that neither knows whether the space
/// between them is empty. Where a sensor's place is known and it looks at the inner one past no
/// surface, that space was seen to be. On which side of a closed mesh something is, the mesh tells; an open
/// one, as a single triangle that is missing leaves it, surrounds what a cloud would.
pub(crate) fn is_enclosed(a: Shape<'_>, b: Shape<'_>, a_from_b: &Pose) -> bool {
    let of = |body: Shape<'_>| {
        let obb = match body {
            Shape::Cloud(cloud) => cloud.around().copied(),
            Shape::Mesh(mesh) => mesh.tree().root().map(|root| *root.obb()),
        };
        obb.map_or((Point3::origin(), 0.0), |obb| (obb.centre, obb.radius()))
    };
    let ((middle_of_a, radius_of_a), (middle_of_b, radius_of_b)) = (of(a), of(b));
    // The larger one cannot be within the smaller.
    let (outer, place) = if radius_of_a >= radius_of_b {
        (a, a_from_b.transform_point(&middle_of_b))
    } else {
        (b, a_from_b.inverse().transform_point(&middle_of_a))
    };
    match outer {
        Shape::Cloud(cloud) => surrounds(cloud, &place),
        Shape::Mesh(mesh) => nearly_surrounds(mesh, &place),
    }
}

/// Whether all but a few of the directions from a place in its local frame end on an open mesh, or where a triangle of
/// it is missing: of a box a single one is a twelfth of all directions.
fn nearly_surrounds(mesh: &Mesh, place: &Point3) -> bool {
    let is_within = || {
        let [low, high] = mesh.corners_of_box();
        (0..3).all(|k| low[k] <= place[k] && place[k] <= high[k])
    };
    !mesh.is_closed() && is_within() && mesh.winding_number_when_filled(place).abs() >= CLOSED
}

fn surrounds(cloud: &Prepared, place: &Point3) -> bool {
    if !cloud.around().is_some_and(|around| around.contains(place)) {
        return false;
    }
    let points = cloud.points();
    let step = points.len().div_ceil(MOST_POINTS).max(1);
    let count = points.len().div_ceil(step);
    let a_side = (count as f64 / (6.0 * POINTS_PER_SQUARE)).sqrt().floor() as usize;
    let a_side = a_side.clamp(1, MOST_SQUARES);
    // An open side is four of the smallest squares: more than may be empty.
    if a_side == MOST_SQUARES
        && cloud.is_searched_at_every_point()
        && has_open_side(cloud.tree(), points, place)
    {
        return false;
    }
    let all = 6 * a_side * a_side;
    let enough = (CLOSED * all as f64).ceil() as u32;
    let squares = Squares::new(a_side);
    let is_seen_into = || cloud.sensor_origins().iter().any(|sensor| sees(cloud, sensor, place));
    let mut filled = 0_u128;
    for point in points.iter().step_by(step) {
        let before = filled;
        filled |= squares.containing(&(point - place));
        if filled != before && filled.count_ones() >= enough {
            // More points fill no less.
            return !is_seen_into();
        }
    }
    // Of a wall nearby few of some points fall in each square. With half of the squares empty it is not all around.
    if step > 1 && 2 * filled.count_ones() as usize >= all {
        let apart = cloud.makeup().spacing * (step as f64).sqrt();
        let near = 0.5 * a_side as f64 * POINTS_PER_SQUARE.sqrt() * apart;
        cloud.visit_measured_within(place, near, |point| {
            filled |= squares.containing(&(point - place));
        });
    }
    // A small square all alone among filled ones has no point by chance, which hangs on the axes of the file.
    let alone = if a_side >= SMALL_SQUARES { squares.alone_among(filled) } else { 0 };
    filled.count_ones() + alone >= enough && !is_seen_into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_open_side_leaves_too_few_squares_filled() {
        let all = 6 * MOST_SQUARES * MOST_SQUARES;
        assert!(((all - 4) as f64) < CLOSED * all as f64);
    }
}
