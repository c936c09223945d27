//! A body with the surface of the other all around it: nothing near says that it touches, and nothing
//! says on which side of that surface it is.

mod open_side;

use cloudtouch_geom::{Point3, Pose, Vector3};

use crate::cloud::Prepared;
use crate::mesh::Mesh;
use crate::shape::Shape;

use open_side::has_open_side;

/// Points that stand for the surface around, at most.
const MOST_POINTS: usize = 4096;
/// Directions are told apart by squares on the faces of a cube, so many a side at most: all of them are
/// the bits of one number.
const MOST_SQUARES: usize = 4;
/// So many points are expected to fall in each square of a closed surface.
const POINTS_PER_SQUARE: f64 = 8.0;
/// With this share of the squares filled there is no way out.
const CLOSED: f64 = 0.97;

/// A way that keeps so many spacings from every point passes no surface.
const SURFACE_SPACINGS: f64 = 1.0;

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

/// Whether all but a few of the directions from a place in its local frame end on an open mesh.
fn nearly_surrounds(mesh: &Mesh, place: &Point3) -> bool {
    let is_within = || {
        let [low, high] = mesh.corners_of_box();
        (0..3).all(|k| low[k] <= place[k] && place[k] <= high[k])
    };
    !mesh.is_closed() && is_within() && mesh.winding_number(place).abs() >= CLOSED
}

fn surrounds(cloud: &Prepared, place: &Point3) -> bool {
    if !cloud.around().is_some_and(|around| around.contains(place)) {
        return false;
    }
    let points = cloud.points();
    let step = points.len().div_ceil(MOST_POINTS).max(1);
    let count = points.len().div_ceil(step);
    let squares = (count as f64 / (6.0 * POINTS_PER_SQUARE)).sqrt().floor() as usize;
    let squares = squares.clamp(1, MOST_SQUARES);
    // An open side is four of the smallest squares: more than may be empty.
    if squares == MOST_SQUARES
        && cloud.is_searched_at_every_point()
        && has_open_side(cloud.tree(), points, place)
    {
        return false;
    }
    let all = 6 * squares * squares;
    let enough = (CLOSED * all as f64).ceil() as u32;
    let squares = Squares::new(squares);
    let mut filled = 0_u128;
    for point in points.iter().step_by(step) {
        let before = filled;
        filled |= squares.containing(&(point - place));
        if filled != before && filled.count_ones() >= enough {
            // More points fill no less.
            return !cloud.sensor_origins().iter().any(|sensor| sees(cloud, sensor, place));
        }
    }
    false
}

/// The squares that directions are told apart by, so many a side.
struct Squares {
    a_side: u32,
    /// Where each but the first begins, from −1 to 1; infinity beyond the last.
    begins: [f64; MOST_SQUARES - 1],
}

impl Squares {
    fn new(a_side: usize) -> Self {
        let begin = |k: usize| 2.0 * (k + 1) as f64 / a_side as f64 - 1.0;
        let begins = std::array::from_fn(|k| if k + 1 < a_side { begin(k) } else { f64::INFINITY });
        Self { a_side: a_side as u32, begins }
    }

    /// The bit of the square that a direction passes; none for no direction.
    ///
    /// Without branches but for that: thousands of directions, each to another square.
    fn containing(&self, direction: &Vector3) -> u128 {
        let around = [direction.x, direction.y, direction.z, direction.x, direction.y];
        let [x, y, z] = [direction.x.abs(), direction.y.abs(), direction.z.abs()];
        let most = x.max(y);
        let axis = if z > most { 2 } else { usize::from(y > x) };
        let size = most.max(z);
        if size == 0.0 || !size.is_finite() {
            return 0;
        }
        let along = |value: f64| -> u32 {
            self.begins.iter().map(|begin| u32::from(value >= begin * size)).sum()
        };
        let face = 2 * axis as u32 + u32::from(around[axis] < 0.0);
        let square = (face * self.a_side + along(around[axis + 1])) * self.a_side;
        1 << (square + along(around[axis + 2]))
    }
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

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed::{derive, unit};

    use super::*;

    /// By division.
    fn square_of(direction: &Vector3, squares: usize) -> Option<usize> {
        let axis = direction.iamax();
        let size = direction[axis].abs();
        if !size.is_finite() || size == 0.0 {
            return None;
        }
        let along = |k: usize| {
            let share = 0.5 * (direction[(axis + k) % 3] / size + 1.0);
            ((share * squares as f64) as usize).min(squares - 1)
        };
        let face = 2 * axis + usize::from(direction[axis] < 0.0);
        Some((face * squares + along(1)) * squares + along(2))
    }

    #[test]
    fn an_open_side_leaves_too_few_squares_filled() {
        let all = 6 * MOST_SQUARES * MOST_SQUARES;
        assert!(((all - 4) as f64) < CLOSED * all as f64);
    }

    #[test]
    fn comparisons_find_the_square_that_division_does() {
        let draw = |i: u64, k| 2.0 * unit(derive(5, i, k)) - 1.0;
        let drawn = (0..4000).map(|i| Vector3::new(draw(i, 0), draw(i, 1), draw(i, 2)));
        let special = [Vector3::zeros(), Vector3::repeat(f64::NAN), Vector3::x(), -Vector3::z()];
        let all: Vec<Vector3> = drawn.chain(special).collect();
        for a_side in 1..=MOST_SQUARES {
            let squares = Squares::new(a_side);
            for direction in &all {
                let expected = square_of(direction, a_side).map_or(0, |square| 1 << square);
                assert_eq!(squares.containing(direction), expected, "{direction:?}");
            }
        }
    }
}
