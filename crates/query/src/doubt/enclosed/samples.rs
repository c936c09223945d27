//! In which directions from a place a cloud has samples.

use cloudtouch_geom::{Matrix3, Point3, Vector3};

use crate::cloud::Prepared;
use crate::some::some_of;

use super::squares::{CLOSED, MOST_SQUARES, Squares};

/// Points that stand for the surface around, at most.
const MOST_POINTS: usize = 4096;
/// So many points are expected to fall in each square of a closed surface.
const POINTS_PER_SQUARE: f64 = 8.0;
/// From so many a side on a square is too small for a way out.
const SMALL_SQUARES: usize = 3;

/// Some points of a cloud, from all over it, and the squares that are as small as they tell.
pub(super) struct Samples<'a> {
    cloud: &'a Prepared,
    /// Those of the squares.
    axes: Matrix3,
    /// Of so many points each stands for one.
    part: f64,
    a_side: usize,
}

impl<'a> Samples<'a> {
    pub(super) fn of(cloud: &'a Prepared, axes: Matrix3) -> Self {
        let all = cloud.points().len();
        let count = all.min(MOST_POINTS);
        let a_side = (count as f64 / (6.0 * POINTS_PER_SQUARE)).sqrt().floor() as usize;
        Self {
            cloud,
            axes,
            part: all as f64 / count.max(1) as f64,
            a_side: a_side.clamp(1, MOST_SQUARES),
        }
    }

    /// Whether they fill the smallest squares.
    pub(super) fn are_many(&self) -> bool {
        self.a_side == MOST_SQUARES
    }

    /// The squares about a place that hold one, or as many as are enough.
    pub(super) fn around(&self, place: &Point3) -> Filled {
        let all = 6 * self.a_side * self.a_side;
        let enough = (CLOSED * all as f64).ceil() as u32;
        let squares = Squares::new(self.axes, self.a_side);
        let mut filled = 0_u128;
        let points = self.cloud.points();
        for index in some_of(points.len(), MOST_POINTS) {
            let point = &points[index];
            let before = filled;
            filled |= squares.containing(&(point - place));
            if filled != before && filled.count_ones() >= enough {
                // More points fill no less.
                return Filled { squares, filled, enough };
            }
        }
        // Of a wall nearby few of some points fall in each square. With half of the squares empty it is not all
        // around.
        if self.part > 1.0 && 2 * filled.count_ones() as usize >= all {
            let apart = self.cloud.makeup().spacing * self.part.sqrt();
            let near = 0.5 * self.a_side as f64 * POINTS_PER_SQUARE.sqrt() * apart;
            self.cloud.visit_measured_within(place, near, |point| {
                filled |= squares.containing(&(point - place));
            });
        }
        // A small square all alone among filled ones has no point by chance.
        if self.a_side >= SMALL_SQUARES {
            filled |= squares.alone_among(filled);
        }
        Filled { squares, filled, enough }
    }
}

/// Squares that hold samples.
pub(super) struct Filled {
    squares: Squares,
    filled: u128,
    enough: u32,
}

impl Filled {
    /// Whether all but a few are.
    pub(super) fn are_all(&self) -> bool {
        self.filled.count_ones() >= self.enough
    }

    /// Whether the square of a direction is one.
    pub(super) fn hold(&self, direction: &Vector3) -> bool {
        self.filled & self.squares.containing(direction) != 0
    }
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
