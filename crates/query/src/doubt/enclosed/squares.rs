//! Directions told apart by squares on the faces of a cube.

use cloudtouch_geom::{Matrix3, Vector3};

/// Directions are told apart by squares on the faces of a cube, so many a side at most: all of them are
/// the bits of one number.
pub(super) const MOST_SQUARES: usize = 4;
/// With this share of the directions filled there is no way out.
pub(super) const CLOSED: f64 = 0.97;

/// The squares that directions are told apart by, so many a side.
pub(super) struct Squares {
    /// Of the cube, as columns; whichever way round, and in whichever order.
    axes: Matrix3,
    a_side: u32,
    /// Where each but the first begins, from −1 to 1; infinity beyond the last.
    begins: [f64; MOST_SQUARES - 1],
}

impl Squares {
    pub(super) fn new(axes: Matrix3, a_side: usize) -> Self {
        let begin = |k: usize| 2.0 * (k + 1) as f64 / a_side as f64 - 1.0;
        let begins = std::array::from_fn(|k| if k + 1 < a_side { begin(k) } else { f64::INFINITY });
        Self { axes, a_side: a_side as u32, begins }
    }

    /// The bit of the square that a direction passes; none for no direction.
    pub(super) fn containing(&self, direction: &Vector3) -> u128 {
        self.containing_along(&self.axes.tr_mul(direction))
    }

    /// Without branches but for no direction: thousands of directions, each to another square.
    fn containing_along(&self, direction: &Vector3) -> u128 {
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

    /// The directions of the middles of all.
    pub(super) fn middles(&self) -> impl Iterator<Item = Vector3> {
        self.middles_along().map(|middle| self.axes * middle)
    }

    fn middles_along(&self) -> impl Iterator<Item = Vector3> + use<> {
        let (a_side, step) = (self.a_side, 2.0 / f64::from(self.a_side));
        let middle = move |k: u32| step * (f64::from(k) + 0.5) - 1.0;
        let of_face = move |face| {
            let all = 0..a_side * a_side;
            all.map(move |k| toward(face, middle(k / a_side), middle(k % a_side)))
        };
        (0..6).flat_map(of_face)
    }

    /// The squares that are not filled while all beside them are.
    pub(super) fn alone_among(&self, filled: u128) -> u128 {
        // Beyond the edge of a face the next one begins.
        let step = 2.0 / f64::from(self.a_side);
        let is_alone = |middle: &Vector3| {
            let axis = middle.iamax();
            let beside = [1, 2].into_iter().flat_map(|k| {
                [step, -step].map(|by| middle + by * Vector3::ith((axis + k) % 3, 1.0))
            });
            let beside = beside.fold(0, |all, direction| all | self.containing_along(&direction));
            filled & self.containing_along(middle) == 0 && filled & beside == beside
        };
        let alone = self.middles_along().filter(is_alone);
        alone.fold(0, |all, middle| all | self.containing_along(&middle))
    }
}

/// The direction to a place on a face of the cube.
fn toward(face: usize, u: f64, v: f64) -> Vector3 {
    let mut direction = Vector3::zeros();
    direction[face / 2] = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
    direction[(face / 2 + 1) % 3] = u;
    direction[(face / 2 + 2) % 3] = v;
    direction
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
    fn a_square_is_alone_where_all_four_beside_it_are_filled() {
        for a_side in 2..=MOST_SQUARES {
            let squares = Squares::new(Matrix3::identity(), a_side);
            let all = (1_u128 << (6 * a_side * a_side)) - 1;
            assert_eq!(squares.alone_among(all), 0);
            for lost in 0..6 * a_side * a_side {
                let without = all & !(1 << lost);
                assert_eq!(squares.alone_among(without), 1 << lost, "{a_side} {lost}");
                // One beside it is not found alone, nor is it then: each has four such.
                let beside = (0..6 * a_side * a_side)
                    .filter(|&other| other != lost)
                    .filter(|other| squares.alone_among(without & !(1 << other)) == 0);
                assert_eq!(beside.count(), 4, "{a_side} {lost}");
            }
        }
    }

    #[test]
    fn comparisons_find_the_square_that_division_does() {
        let draw = |i: u64, k| 2.0 * unit(derive(5, i, k)) - 1.0;
        let drawn = (0..4000).map(|i| Vector3::new(draw(i, 0), draw(i, 1), draw(i, 2)));
        let special = [Vector3::zeros(), Vector3::repeat(f64::NAN), Vector3::x(), -Vector3::z()];
        let all: Vec<Vector3> = drawn.chain(special).collect();
        for a_side in 1..=MOST_SQUARES {
            let squares = Squares::new(Matrix3::identity(), a_side);
            for direction in &all {
                let expected = square_of(direction, a_side).map_or(0, |square| 1 << square);
                assert_eq!(squares.containing(direction), expected, "{direction:?}");
            }
        }
    }
}
