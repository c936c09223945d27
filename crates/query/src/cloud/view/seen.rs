//! What a view knows of a place, by how far it saw in its direction.

use cloudtouch_geom::Vector3;

use super::raster::{Cell, Raster};

/// A place is in a hole when nothing was measured so many cells around its own: every hole eight pixels wide has
/// such places, and smaller ones are specks that hardly a surface hides in.
pub(super) const HOLE_CELLS: isize = 1;
/// A surface recedes across a cell when it did so before it at this part of the rate: of two directions one has half.
const STEADY: f64 = 0.4;
/// What is no farther behind a return, m, may be inside the thing it came from: few things on a table are thicker.
const CLOSE: f64 = 0.03;

/// What a camera knows of a place; what comes first is known better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Sight {
    /// It looked there and beyond, and met nothing on the way.
    Seen,
    /// All that it met around there is before the place, and some of it close before.
    CloseBehind,
    /// It met a surface before the place.
    BehindReturns,
    /// No return came from there.
    Hole,
    /// Returns from so far were left out.
    OutOfRange,
    /// The place is beside what it looked at.
    OutsideView,
    /// The place is behind the camera's back.
    BehindCamera,
}

impl Sight {
    /// Whether something was met before the place.
    pub(crate) fn is_behind(self) -> bool {
        matches!(self, Self::CloseBehind | Self::BehindReturns)
    }
}

impl Raster {
    /// What is known of the place that a ray leads to.
    pub(super) fn sight(&self, ray: &Vector3) -> Sight {
        if self.lens.is_behind(ray) {
            return Sight::BehindCamera;
        }
        let place = self.lens.project(ray).and_then(|at| Some((at, self.grid.cell(at)?)));
        let Some((at, [x, y])) = place else {
            return Sight::OutsideView;
        };
        let range = ray.norm();
        let is_behind_lines =
            || self.between_lines(at[1], [x, y]).is_some_and(|lines| range > lines.behind);
        // The nearest ring of cells with a return tells: of the cell itself the nearest return that a surface may end
        // at, since what hides behind the rim of something is behind part of a cell only; of those around, across specks,
        // the farthest.
        for ring in 0..=HOLE_CELLS {
            let (mut farthest, mut is_open) = (0.0_f64, false);
            for dy in -ring..=ring {
                let step = if dy.abs() == ring { 1 } else { 2 * ring.max(1) };
                for dx in (-ring..=ring).step_by(step as usize) {
                    if let Some(cell) = self.grid.index(x + dx, y + dy) {
                        let behind = self.cells[cell].clearly_behind;
                        let told = if ring == 0 { self.behind_rim(range, [x, y]) } else { behind };
                        farthest = farthest.max(told);
                        is_open |= self.is_open.get(cell).is_some_and(|&is_open| is_open);
                    }
                }
            }
            if farthest > 0.0 {
                // What lines have between them is told by these.
                let is_speck = ring > 0 && self.lines.is_none();
                let brink =
                    if is_speck { self.behind_brink(ray, at, [x, y]) } else { f64::INFINITY };
                return match range > farthest {
                    true if is_open => Sight::OutOfRange,
                    true if self.is_close_behind(range, [x, y]) => Sight::CloseBehind,
                    true => Sight::BehindReturns,
                    false if range > brink && range <= brink + CLOSE => Sight::CloseBehind,
                    false if range > brink || is_behind_lines() => Sight::BehindReturns,
                    false if self.is_behind_surface(ray, at, [x, y]) => Sight::BehindReturns,
                    false => Sight::Seen,
                };
            }
        }
        Sight::Hole
    }

    /// The range behind which something is hidden by part of a cell at least: behind the nearest return there, unless a
    /// surface recedes from before the cell to beyond it.
    fn behind_rim(&self, range: f64, [x, y]: [isize; 2]) -> f64 {
        let Some(cell) = self.grid.index(x, y) else { return 0.0 };
        let Cell { behind_nearest: nearest, clearly_behind: farthest, .. } = self.cells[cell];
        let recedes = || {
            let before = nearest - STEADY * (farthest - nearest);
            let beside =
                [[1, 0], [-1, 0], [0, 1], [0, -1]].map(|[dx, dy]| self.grid.index(x + dx, y + dy));
            beside.into_iter().flatten().any(|cell| self.cells[cell].behind_nearest <= before)
        };
        if nearest < range && range <= farthest && recedes() {
            farthest
        } else {
            nearest.min(farthest)
        }
    }

    /// Whether a range is behind all returns of a cell, by so little that it may be inside what they came from. The
    /// nearest alone would be passed by what lies on a surface that is seen at a low angle.
    fn is_close_behind(&self, range: f64, [x, y]: [isize; 2]) -> bool {
        let behind = self.grid.index(x, y).map_or(0.0, |cell| self.cells[cell].clearly_behind);
        range > behind && range <= behind + CLOSE
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]
mod tests {
    use cloudtouch_geom::Point3;
    use nalgebra::UnitQuaternion;

    use super::*;

    /// Of a cell half before a thing and half past it, what is behind the thing counted as seen.
    #[test]
    fn what_hides_behind_a_rim_is_behind_it() {
        for rim in [20, 21] {
            let ray = |column: usize, row: usize| {
                Vector3::new((column as f64 - 19.5) / 40.0, (row as f64 - 14.5) / 40.0, 1.0)
            };
            let depth = |column| if column < rim { 1.0 } else { 2.0 };
            let pixels = (0..30).flat_map(|row| (0..40).map(move |column| (column, row)));
            let measured = pixels.map(|(c, r)| (Point3::from(ray(c, r) * depth(c)), 0.001));
            let turn = UnitQuaternion::identity();
            let raster =
                Raster::new((&Point3::origin(), &turn, None), measured, &[], [40, 30]).unwrap();
            for column in 0..40 {
                let sight = raster.sight(&(ray(column, 14) * 1.5));
                if column < rim {
                    assert_eq!(sight, Sight::BehindReturns, "{rim} {column}");
                } else if column > rim + 1 {
                    assert_eq!(sight, Sight::Seen, "{rim} {column}");
                }
            }
        }
    }
}
