//! How far a camera saw in each direction of its view.
//!
//! Directions are looked up in a raster over the view, of cells two pixels wide, and not among the
//! measured directions: a query looks at hundreds of them.

use std::f64::consts::TAU;
use std::sync::OnceLock;

use cloudtouch_geom::{Point3, Vector3};
use nalgebra::UnitQuaternion;

use super::extent::extent;
use super::lens::Lens;
use super::lines::Lines;
use super::straight::Mean;

/// Edge of a raster's cell in pixels: no cell between measured pixels is left empty by chance.
const CELL_PIXELS: f64 = 2.0;
/// Standard deviations of the measured surface that count as clearly behind it.
pub(in crate::cloud) const CLEARLY: f64 = 3.0;
/// Lines that are farther apart than so many of their pixels are lines.
const APART: f64 = 1.5;
/// One that lacks no more cells than that of a full turn goes all around.
const LEAST_GAP_CELLS: f64 = 2.0;
/// The first column of a full turn begins so many of its pixels before straight ahead: a part that no fraction is, so
/// that no column is where cells meet, however many pixels wide these are.
const ASIDE: f64 = 0.309_016_994_374_947_4;
/// Cells of a raster at most, and columns or rows: beyond, they become wider.
const MOST_CELLS: f64 = 1e7;
const MOST_COLUMNS: f64 = 1e4;

/// How far was seen in each direction of a view.
#[derive(Debug)]
pub(super) struct Raster {
    pub(super) lens: Lens,
    low: [f64; 2],
    pitch: f64,
    /// Columns and rows.
    pub(super) size: [usize; 2],
    /// Cells up to half of one past the outermost pixels: the last of a row or a column may reach beyond.
    span: [f64; 2],
    /// Whether the last column is beside the first.
    is_round: bool,
    /// How many columns and rows of cells it takes to reach a pixel beside one.
    pub(super) reach: [isize; 2],
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

    /// How much farther than its nearest return is clearly behind it, m; zero without one.
    pub(super) fn clear(&self) -> f64 {
        if self.clearly_behind > 0.0 { self.behind_nearest - self.nearest() } else { 0.0 }
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
    ///
    /// Cells are as large as pixels are, however many of these have no return: by the returns alone holes
    /// would be the smaller the more of them there are.
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
        let place = |(number, (ray, range, clear)): (usize, &(Vector3, f64, f64))| {
            Some((number, [range - clear, range + clear], lens.project(ray)?))
        };
        let placed: Vec<_> = rays.iter().enumerate().filter_map(place).collect();
        let [low, high] = extent(&lens, placed.iter().map(|(_, _, at)| *at));
        let mut sides = [high[0] - low[0], high[1] - low[1]];
        let pixel_count = (pixels[0] * pixels[1]).max(placed.len()).max(1) as f64;
        let pitch_over = |[width, height]: [f64; 2]| {
            let area = width * height;
            (CELL_PIXELS * (area / pixel_count).sqrt())
                .max((area / MOST_CELLS).sqrt())
                .max(width.max(height) / MOST_COLUMNS)
        };
        let mut pitch = pitch_over(sides);
        if !(pitch > 0.0 && pitch.is_finite()) {
            return None;
        }
        let is_round =
            matches!(lens, Lens::Panorama(_)) && sides[0] + LEAST_GAP_CELLS * pitch > TAU;
        if is_round {
            // Whether a full turn lacks a column is told by rounding, where one is straight behind.
            sides[0] = TAU;
            pitch = TAU / (TAU / pitch_over(sides)).round().max(1.0);
        }
        let steps = match lens {
            Lens::Camera(_) => [pitch / CELL_PIXELS; 2],
            Lens::Panorama(_) => steps_of_panorama(sides, pixels),
        };
        // A pixel's surface reaches beyond its middle: half a cell around the outermost ones.
        let mut low = low.map(|v| v - 0.5 * pitch);
        if is_round {
            // None is outermost, and rounding would tell which is first where one is straight ahead, and in which cell
            // one is that is where two meet.
            low[0] = -ASIDE * steps[0];
        }
        let span = sides.map(|side| side / pitch + 1.0);
        let mut size = span.map(|cells| cells.ceil() as usize);
        if is_round {
            size[0] = (TAU / pitch).round() as usize;
        }
        let count = size[0] * size[1];
        let reach = steps.map(|step| (step / pitch).ceil().max(1.0) as isize);
        let is_open = vec![false; if beyond.is_empty() { 0 } else { count }];
        let mut raster = Self {
            lens,
            low,
            pitch,
            size,
            span,
            is_round,
            reach,
            cells: vec![Cell::EMPTY; count],
            means: vec![Mean::default(); count],
            is_open,
            lines: (steps[1] > APART * steps[0]).then(|| Lines::new(count, steps[1])),
            seen: OnceLock::new(),
        };
        for (number, [before, behind], at) in placed {
            let place = raster.cell(at).and_then(|at| Some((at, raster.index(at[0], at[1])?)));
            if let Some((middle, cell)) = place {
                raster.cells[cell].add([before, behind]);
                let (ray, range, _) = &rays[number];
                let distance = raster.lens.distance(ray, *range);
                let aside = raster.place_in(at, middle);
                raster.means[cell].add(aside, distance);
                if number >= returns {
                    raster.is_open[cell] = true;
                }
                if let Some(lines) = &mut raster.lines {
                    lines.add(cell, at[1], behind);
                }
            }
        }
        Some(raster)
    }

    /// How far apart pixels are, per metre of distance; `None` of a panorama, whose lines may be far apart.
    pub(super) fn pixel(&self) -> Option<f64> {
        matches!(self.lens, Lens::Camera(_)).then_some(self.pitch / CELL_PIXELS)
    }

    /// The cell of a place of the view; `None` outside of it.
    pub(super) fn cell(&self, at: [f64; 2]) -> Option<[isize; 2]> {
        let [x, y] = [0, 1].map(|axis| (at[axis] - self.low[axis]) / self.pitch);
        let is_within =
            |v: f64, axis: usize| self.is_round && axis == 0 || v >= 0.0 && v < self.span[axis];
        // What is just left of the first column of a round one is in the last.
        (is_within(x, 0) && is_within(y, 1)).then_some([x.floor() as isize, y.floor() as isize])
    }

    /// Where a place of the view is in its cell, from the middle, in cells.
    pub(super) fn place_in(&self, at: [f64; 2], cell: [isize; 2]) -> [f64; 2] {
        [0, 1].map(|axis| (at[axis] - self.low[axis]) / self.pitch - cell[axis] as f64 - 0.5)
    }

    pub(super) fn index(&self, x: isize, y: isize) -> Option<usize> {
        let x = if self.is_round { x.rem_euclid(self.size[0] as isize) } else { x };
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        (x < self.size[0] && y < self.size[1]).then_some(y * self.size[0] + x)
    }
}

/// How far apart the pixels of a panorama are in azimuth and in elevation, rad: its lines, be they its rows or its
/// columns, as makes these more alike.
fn steps_of_panorama(extent: [f64; 2], [columns, rows]: [usize; 2]) -> [f64; 2] {
    let of = |counts: [usize; 2]| {
        [0, 1].map(|axis| extent[axis] / counts[axis].saturating_sub(1).max(1) as f64)
    };
    let unlike = |[p, q]: [f64; 2]| (p / q).ln().abs();
    let both = [of([columns, rows]), of([rows, columns])];
    if unlike(both[1]) < unlike(both[0]) { both[1] } else { both[0] }
}

#[cfg(test)]
mod tests {
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
            assert_eq!(raster.size, rasters[0].size);
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
