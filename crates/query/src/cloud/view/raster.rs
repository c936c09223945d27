//! How far a camera saw in each direction of its view.
//!
//! Directions are looked up in a raster over the view, of cells two pixels wide, and not among the
//! measured directions: a query looks at hundreds of them.

use std::sync::OnceLock;

use cloudtouch_geom::{Point3, Vector3};
use nalgebra::UnitQuaternion;

use super::grid::Grid;
use super::lens::Lens;
use super::lines::Lines;
use super::straight::Mean;

/// Standard deviations of the measured surface that count as clearly behind it.
pub(in crate::cloud) const CLEARLY: f64 = 3.0;
/// Lines that are farther apart than so many of their pixels are lines.
const APART: f64 = 1.5;

/// How far was seen in each direction of a view.
#[derive(Debug)]
pub(super) struct Raster {
    pub(super) lens: Lens,
    pub(super) grid: Grid,
    // PERF: what is told of a cell is looked up at once.
    pub(super) cells: Vec<Cell>,
    /// The same in the mean.
    pub(super) means: Vec<Mean>,
    /// Of each cell whether what is farther was left out; empty where nothing was.
    pub(super) is_open: Vec<bool>,
    /// Of a panorama whose lines are farther apart than the pixels of one.
    pub(super) lines: Option<Lines>,
    /// How far was seen, once that is needed.
    pub(super) seen: OnceLock<Seen>,
}

/// How far was seen.
#[derive(Debug)]
pub(super) struct Seen {
    /// The range of the nearest return of each cell and those around it, m, beyond which a surface may be between returns
    /// or another image may know one better; infinite without one.
    pub(super) about: Vec<f64>,
    /// Up to which range all of a block of cells was seen, m.
    pub(super) blocks: Vec<f64>,
}

/// What was met in a cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cell {
    /// The range, m, clearly behind the farthest return; zero without one.
    pub(super) clearly_behind: f64,
    /// The range, m, clearly behind the nearest return; infinite without one.
    pub(super) behind_nearest: f64,
    /// The range, m, clearly before the nearest return; infinite without one.
    pub(super) clearly_before: f64,
}

impl Cell {
    const EMPTY: Self =
        Self { clearly_behind: 0.0, behind_nearest: f64::INFINITY, clearly_before: f64::INFINITY };

    /// The range of the nearest return, m; infinite without one.
    pub(super) fn nearest(&self) -> f64 {
        0.5 * (self.clearly_before + self.behind_nearest)
    }

    /// Whether it has no return.
    pub(super) fn is_empty(&self) -> bool {
        self.clearly_behind == 0.0
    }

    /// How much farther than its nearest return is clearly behind it, m; zero without one.
    pub(super) fn clear(&self) -> f64 {
        if self.is_empty() { 0.0 } else { self.behind_nearest - self.nearest() }
    }

    fn add(&mut self, [before, behind]: [f64; 2]) {
        self.clearly_behind = self.clearly_behind.max(behind);
        self.behind_nearest = self.behind_nearest.min(behind);
        self.clearly_before = self.clearly_before.min(before);
    }
}

impl Raster {
    /// Of the points measured, each with an upper bound of its standard deviations, m, in so many pixels, and of
    /// rays `beyond` which returns were left out.
    pub(super) fn new(
        (origin, turn, scanner): (&Point3, &UnitQuaternion<f64>, Option<f64>),
        measured: impl Iterator<Item = (Point3, f64)>,
        beyond: &[Vector3],
        pixels: [usize; 2],
    ) -> Option<Self> {
        let ray = |(place, std): (Point3, f64)| {
            let ray = place - origin;
            (ray, ray.norm(), CLEARLY * std)
        };
        let mut rays: Vec<(Vector3, f64, f64)> = measured.map(ray).collect();
        let returns = rays.len();
        rays.extend(beyond.iter().map(|ray| (*ray, ray.norm(), 0.0)));
        let lens = Lens::of(rays.iter().map(|(ray, range, _)| (ray, *range)), (turn, scanner))?;
        let place =
            |(number, (ray, ..)): (usize, &(Vector3, f64, f64))| Some((number, lens.project(ray)?));
        let placed: Vec<_> = rays.iter().enumerate().filter_map(place).collect();
        let grid = Grid::over(&lens, placed.iter().map(|(_, at)| *at), pixels)?;
        let (count, [pixels_apart, lines_apart]) = (grid.count(), grid.steps);
        let mut raster = Self {
            lens,
            grid,
            cells: vec![Cell::EMPTY; count],
            means: vec![Mean::default(); count],
            is_open: vec![false; if beyond.is_empty() { 0 } else { count }],
            lines: (lines_apart > APART * pixels_apart).then(|| Lines::new(count, lines_apart)),
            seen: OnceLock::new(),
        };
        for (number, at) in placed {
            raster.add(at, &rays[number], number >= returns);
        }
        Some(raster)
    }

    /// Takes a ray at a place of the view, with its range and how much nearer or farther is clearly so, m; beyond an open
    /// one something may have been left out.
    fn add(&mut self, at: [f64; 2], (ray, range, clear): &(Vector3, f64, f64), is_open: bool) {
        let Some([x, y]) = self.grid.cell(at) else { return };
        let Some(cell) = self.grid.index(x, y) else { return };
        self.cells[cell].add([range - clear, range + clear]);
        self.means[cell].add(self.grid.place_in(at, [x, y]), self.lens.distance(ray, *range));
        if is_open {
            self.is_open[cell] = true;
        }
        if let Some(lines) = &mut self.lines {
            lines.add(cell, at[1], [range + clear, *clear]);
        }
    }

    /// How far apart pixels are, per metre of distance; `None` of a panorama, whose lines may be far apart.
    pub(super) fn pixel(&self) -> Option<f64> {
        matches!(self.lens, Lens::Camera(_)).then_some(self.grid.pixel())
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::cloud::view::seen::Sight;

    /// Of a scanner in a ball of 5 m, with a thing 1 m away beside straight ahead, on the one side or the other.
    fn raster(is_left: bool, first: f64) -> Raster {
        let ray = |i: usize| {
            let (azimuth, up) = ((i % 360) as f64, (i / 360) as f64 - 20.0);
            let is_thing = azimuth == if is_left { 1.0 } else { 359.0 };
            let (sin, cos) = (azimuth + first).to_radians().sin_cos();
            let up = up.to_radians();
            let range = if is_thing { 1.0 } else { 5.0 };
            (Point3::new(cos * up.cos(), sin * up.cos(), up.sin()) * range, 0.01)
        };
        let turn = UnitQuaternion::identity();
        Raster::new((&Point3::origin(), &turn, None), (0..360 * 41).map(ray), &[], [360, 41])
            .unwrap()
    }

    /// What was just right of straight ahead was not beside what was there, for azimuths begin there.
    #[test]
    fn the_last_column_of_a_panorama_is_beside_the_first() {
        for (is_left, first) in [true, false].into_iter().flat_map(|is| [(is, 0.0), (is, 0.7)]) {
            let raster = raster(is_left, first);
            let side = if is_left { 1.0 } else { -1.0 };
            for (degrees, is_past) in [(0.0, false), (side, false), (8.0 * side, true)] {
                let (sin, cos) = f64::to_radians(degrees + first).sin_cos();
                let ray = 3.0 * Vector3::new(cos, sin, 0.0);
                assert_eq!(raster.looks_past(&ray, 0.01), is_past, "{is_left} {degrees}");
                assert_ne!(raster.sight(&ray), Sight::OutsideView);
            }
        }
    }

    /// With some returns of the column straight behind on either side, by rounding, cells were one fewer and wider.
    #[test]
    fn how_many_cells_a_turn_has_hangs_on_no_rounding_of_the_last_column() {
        let rasters = [0.0, 1e-15, 1e-14, 1e-13, 1e-12].map(|aside| {
            let ray = |i: usize| {
                let (column, row) = ((i % 1024) as f64, (i / 1024) as f64);
                let azimuth = column * TAU / 1024.0 + if row % 2.0 == 0.0 { aside } else { -aside };
                let up = (row / 31.0 - 0.5) * TAU / 7.996;
                let ahead =
                    Vector3::new(azimuth.cos() * up.cos(), azimuth.sin() * up.cos(), up.sin());
                (Point3::from(5.0 * ahead), 0.01)
            };
            let (origin, turn) = (Point3::origin(), UnitQuaternion::identity());
            Raster::new((&origin, &turn, None), (0..1024 * 32).map(ray), &[], [1024, 32]).unwrap()
        });
        for raster in &rasters {
            assert_eq!(raster.grid.size, rasters[0].grid.size);
        }
    }

    /// A column straight ahead was the first or the last of the turn as rounding had it, and all cells lay a column
    /// aside: in one frame a body was behind a thing, in another beside it.
    #[test]
    fn what_is_behind_a_thing_hangs_on_no_rounding_of_the_first_column() {
        let rasters = [0.0, 1e-12, -1e-12].map(|first| raster(true, first));
        let sights = rasters.each_ref().map(|raster| {
            let azimuths = (0..200).map(|k| 0.03 * f64::from(k) - 3.0);
            let ray = |azimuth: f64| {
                let (sin, cos) = azimuth.to_radians().sin_cos();
                3.0 * Vector3::new(cos, sin, 0.0)
            };
            azimuths.map(|azimuth| raster.sight(&ray(azimuth))).collect::<Vec<_>>()
        });
        assert!(sights[0].iter().any(|sight| sight.is_behind()));
        assert_eq!(sights[0], sights[1]);
        assert_eq!(sights[0], sights[2]);
    }
}
