//! Positions about a cell, and how far the nearest of them are from one of its points.

use cloudtouch_geom::Point3;

use crate::index::octree::{Cell, Octree};
use crate::index::spacing::SPACING_NEIGHBORS;
use crate::lanes::{Kernel, Lanes, Machine, Stored, WIDTH, run};

/// As many neighbours as tell the spacing, and the point itself.
pub(crate) const NEAREST: usize = SPACING_NEIGHBORS + 1;

/// All positions about a cell.
#[derive(Debug, Default)]
pub(crate) struct Held {
    /// Their coordinates in lanes; infinite in lanes without a position.
    groups: Vec<[Stored; 3]>,
    /// No position is nearer to a point of the cell than this and not held, m².
    complete: f64,
}

impl Held {
    /// Holds what is about another cell from now on, unless that may be more than so many; whether it does.
    pub(crate) fn hold(&mut self, tree: &Octree, cell: &Cell, most: usize) -> bool {
        self.groups.clear();
        let (groups, mut group, mut lane) = (&mut self.groups, NONE, 0);
        let radius = tree.visit_around(cell, most, |point| {
            for (lanes, value) in group.iter_mut().zip(point.iter()) {
                lanes[lane % WIDTH] = *value;
            }
            lane += 1;
            if lane == WIDTH {
                groups.push(group);
                (group, lane) = (NONE, 0);
            }
        });
        groups.push(group);
        self.complete = radius.unwrap_or(0.0).powi(2);
        radius.is_some()
    }

    /// The least squared distances from a point of the cell, m², in order; `None` where others may be
    /// nearer, or there are not so many.
    pub(crate) fn nearest(&self, place: &Point3) -> Option<[f64; NEAREST]> {
        let nearest = run(Nearest { held: self, place });
        nearest[NEAREST - 1].is_finite().then_some(nearest)
    }
}

/// Lanes without a position.
const NONE: [Stored; 3] = [[f64::INFINITY; WIDTH]; 3];

/// Selects the least squared distances, as far as these are complete.
struct Nearest<'a> {
    held: &'a Held,
    place: &'a Point3,
}

impl Kernel for Nearest<'_> {
    type Output = [f64; NEAREST];

    #[inline(always)]
    fn run<S: Machine>(self, machine: S) -> Self::Output {
        let Self { held: Held { groups, complete, .. }, place } = self;
        let mut nearest = [f64::INFINITY; NEAREST];
        let mut most = *complete;
        for &[x, y, z] in groups {
            let from = |values, value| Lanes::load(machine, values) - Lanes::splat(machine, value);
            let [x, y, z] = [from(x, place.x), from(y, place.y), from(z, place.z)];
            let squares = (x * x + y * y + z * z).stored();
            // PERF: those of a group are near one another, so that mostly all of them are too far.
            let [p, q, r, s] = squares;
            if !((p < most) | (q < most) | (r < most) | (s < most)) {
                continue;
            }
            for square in squares {
                if square < most {
                    insert(&mut nearest, square);
                    let last = nearest[NEAREST - 1];
                    most = if last < most { last } else { most };
                }
            }
        }
        nearest
    }
}

/// Puts a number among the least, if it is one of them.
#[inline(always)]
fn insert(least: &mut [f64; NEAREST], mut value: f64) {
    for slot in least {
        // PERF: where it goes is hard to foresee, and which is less one instruction.
        let (less, more) = if value < *slot { (value, *slot) } else { (*slot, value) };
        (*slot, value) = (less, more);
    }
}
