//! What a view knows of where it has no returns, by those about: between pixels, across a hole, and between lines.

use cloudtouch_geom::Vector3;

use super::lines::Between;
use super::raster::Raster;
use super::seen::HOLE_CELLS;
use super::straight::{REACH, Surface};

/// How many cells across holes are that count as seen.
const ACROSS: isize = 2 * HOLE_CELLS + 2;

impl Raster {
    /// Whether a place is clearly behind the surface that a cell and those around it are on, where that is even.
    pub(super) fn is_behind_surface(
        &self,
        ray: &Vector3,
        at: [f64; 2],
        [x, y]: [isize; 2],
    ) -> bool {
        let Some(own) = self.grid.index(x, y) else { return false };
        let (range, clear) = (ray.norm(), self.cells[own].clear());
        if range <= self.seen().about[own] + clear {
            return false;
        }
        let around = self.grid.around([x, y], [REACH; 2]);
        self.behind_plane(ray, (at, [x, y]), around, clear).is_some_and(|behind| range > behind)
    }

    /// The range clearly behind the surface that what is beside a cell without returns is on; where that is no plane, behind
    /// the nearest of it: between a thing and what is behind it nothing tells which of them goes on.
    pub(super) fn behind_brink(&self, ray: &Vector3, at: [f64; 2], cell: [isize; 2]) -> f64 {
        let nearest = || self.brink(cell).map(|(_, cell)| self.cells[cell].behind_nearest);
        let plane = self.behind_plane(ray, (at, cell), self.brink(cell), 0.0);
        plane.unwrap_or_else(|| nearest().fold(f64::INFINITY, f64::min))
    }

    /// The range clearly behind the plane that some cells are on, as [`Self::plane`].
    fn behind_plane(
        &self,
        ray: &Vector3,
        place: ([f64; 2], [isize; 2]),
        cells: impl Iterator<Item = ([isize; 2], usize)>,
        clear: f64,
    ) -> Option<f64> {
        self.plane(ray, place, cells, clear).map(|[range, clear]| range + clear)
    }

    /// The range of the plane that some cells are on along a ray, and how much farther or nearer is clearly behind it or
    /// before it, m, returns being known at least this well; `None` where they are on none.
    pub(super) fn plane(
        &self,
        ray: &Vector3,
        (at, cell): ([f64; 2], [isize; 2]),
        cells: impl Iterator<Item = ([isize; 2], usize)>,
        mut clear: f64,
    ) -> Option<[f64; 2]> {
        let mut surface = Surface::default();
        for (aside, cell) in cells {
            clear = clear.max(self.cells[cell].clear());
            surface.add(aside, self.means[cell]);
        }
        let range = ray.norm();
        let distance = surface.distance(clear, self.grid.place_in(at, cell))?;
        Some([distance * range / self.lens.distance(ray, range), clear])
    }

    /// The first cells with returns on all sides of one without, no farther away than across a hole that counts as seen.
    pub(super) fn brink(
        &self,
        [x, y]: [isize; 2],
    ) -> impl Iterator<Item = ([isize; 2], usize)> + '_ {
        let sides = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| [dx, dy]));
        sides.filter(|side| *side != [0, 0]).filter_map(move |side| {
            (1..=ACROSS).find_map(|steps| {
                let aside = side.map(|k| k * steps);
                let cell = self.grid.index(x + aside[0], y + aside[1])?;
                (!self.cells[cell].is_empty()).then_some((aside, cell))
            })
        })
    }

    /// How far apart what looked about a direction is, rad: the pixels of a camera, or the lines of a panorama that has
    /// some.
    pub(super) fn apart(&self, ray: &Vector3) -> Option<f64> {
        if self.lines.is_none() {
            return Some(self.grid.pixel());
        }
        let at = self.lens.project(ray)?;
        Some(self.between_lines(at[1], self.grid.cell(at)?)?.apart)
    }

    /// What two lines of a panorama have between them, where these are next to one another.
    pub(super) fn between_lines(&self, elevation: f64, [x, y]: [isize; 2]) -> Option<Between> {
        let cell = |y| self.grid.index(x, y);
        // However far apart they are: those of some scanners are the farther apart the farther down they look.
        let down = (0..=y).rev().filter_map(cell);
        let up = (y..self.grid.size[1] as isize).filter_map(cell);
        self.lines.as_ref()?.between(elevation, down, up)
    }
}
