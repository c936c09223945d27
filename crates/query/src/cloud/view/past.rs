//! Whether a view looked past a place, and what is before one.

use cloudtouch_geom::Vector3;

use super::raster::{CLEARLY, Raster};
use super::straight::REACH;

/// How far off a plane of four cells or more may be, of what a single return may be off.
const OF_PLANE: f64 = 0.5;

impl Raster {
    /// Whether every return of the cell of a ray, where there is one, and of those around it, some of them on each
    /// side, is clearly behind a place known this well.
    pub(super) fn looks_past(&self, ray: &Vector3, std: f64) -> bool {
        let mut nearest = f64::INFINITY;
        // Here, left, right, above and below.
        let mut has_return = [false; 5];
        for ([dx, dy], cell) in self.around(ray) {
            nearest = nearest.min(self.cells[cell].clearly_before);
            let is_of = [dx == 0 && dy == 0, dx < 0, dx > 0, dy < 0, dy > 0];
            for (has, is_of) in has_return.iter_mut().zip(is_of) {
                *has |= is_of;
            }
        }
        has_return == [true; 5] && ray.norm() + CLEARLY * std < nearest
    }

    /// Whether a place known this well is clearly before the plane that the pixels around its ray are on. A table that is
    /// seen aslant, or with much noise, has its nearest return well before it. Lines of a panorama are too far apart.
    pub(super) fn is_before_plane(&self, ray: &Vector3, std: f64) -> bool {
        let Some(at) = self.pixel().and_then(|_| self.lens.project(ray)) else { return false };
        let Some(cell) = self.grid.cell(at) else { return false };
        let plane = self.plane(ray, (at, cell), self.grid.around(cell, [REACH; 2]), 0.0);
        plane.is_some_and(|[range, clear]| {
            ray.norm() + (OF_PLANE * clear).hypot(CLEARLY * std) < range
        })
    }

    /// How far away what hides a place is, and its standard deviation, m; `None` where some of what is around the
    /// place's direction does not hide it, such as at the rim of a thing or about a speck.
    pub(super) fn hiding(&self, ray: &Vector3) -> Option<[f64; 2]> {
        let range = ray.norm();
        let (mut before, mut behind) = (f64::INFINITY, f64::INFINITY);
        for (_, cell) in self.around(ray) {
            if range <= self.cells[cell].behind_nearest {
                return None;
            }
            before = before.min(self.cells[cell].clearly_before);
            behind = behind.min(self.cells[cell].behind_nearest);
        }
        behind.is_finite().then(|| [0.5 * (before + behind), 0.5 * (behind - before) / CLEARLY])
    }

    /// Of a place that counts as seen and is behind the nearest return of its cell, how far behind it that may be, m.
    pub(super) fn behind_by_noise(&self, ray: &Vector3) -> Option<f64> {
        let [x, y] = self.lens.project(ray).and_then(|at| self.grid.cell(at))?;
        let cell = &self.cells[self.grid.index(x, y)?];
        let (nearest, range) = (cell.nearest(), ray.norm());
        (nearest < range && range <= cell.clearly_behind).then_some(cell.behind_nearest - nearest)
    }

    /// The cells with returns among that of a ray and those around it, each with how far right and below it is; none
    /// beside the view.
    fn around(&self, ray: &Vector3) -> impl Iterator<Item = ([isize; 2], usize)> {
        let middle = self.lens.project(ray).and_then(|at| self.grid.cell(at));
        let around =
            middle.into_iter().flat_map(|middle| self.grid.around(middle, self.grid.reach()));
        around.filter(|(_, cell)| !self.cells[*cell].is_empty())
    }
}
