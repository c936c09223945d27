//! Where the cells of a raster lie in its view, and which of them a place is in.

use std::f64::consts::TAU;

use super::extent::extent;
use super::lens::Lens;

/// Edge of a cell in pixels: no cell between measured pixels is left empty by chance.
const CELL_PIXELS: f64 = 2.0;
/// One that lacks no more cells than that of a full turn goes all around.
const LEAST_GAP_CELLS: f64 = 2.0;
/// The first column of a full turn begins so many of its pixels before straight ahead: a part that no fraction is, so
/// that no column is where cells meet, however many pixels wide these are.
const ASIDE: f64 = 0.309_016_994_374_947_4;
/// Cells at most, and columns or rows: beyond, they become wider.
const MOST_CELLS: f64 = 1e7;
const MOST_COLUMNS: f64 = 1e4;

/// Square cells over a view.
#[derive(Debug)]
pub(super) struct Grid {
    low: [f64; 2],
    pitch: f64,
    /// Columns and rows.
    pub(super) size: [usize; 2],
    /// Cells up to half of one past the outermost pixels: the last of a row or a column may reach beyond.
    span: [f64; 2],
    /// Whether the last column is beside the first.
    is_round: bool,
    /// How far apart pixels are along both axes.
    pub(super) steps: [f64; 2],
}

impl Grid {
    /// Over all places of a view, in so many pixels; `None` of places without extent.
    ///
    /// Cells are as large as pixels are, however many of these have no return: by the returns alone holes
    /// would be the smaller the more of them there are.
    pub(super) fn over(
        lens: &Lens,
        places: impl ExactSizeIterator<Item = [f64; 2]> + Clone,
        pixels: [usize; 2],
    ) -> Option<Self> {
        let count = (pixels[0] * pixels[1]).max(places.len()).max(1) as f64;
        let [low, high] = extent(lens, places);
        let sides = [high[0] - low[0], high[1] - low[1]];
        let pitch = pitch_over(sides, count);
        if !(pitch > 0.0 && pitch.is_finite()) {
            return None;
        }
        Some(match lens {
            Lens::Camera(_) => Self::flat(low, sides, pitch, [pitch / CELL_PIXELS; 2]),
            Lens::Panorama(_) if sides[0] + LEAST_GAP_CELLS * pitch > TAU => {
                // Whether a full turn lacks a column is told by rounding, where one is straight behind.
                let sides = [TAU, sides[1]];
                Self::round(low, sides, pitch_over(sides, count), steps_of_panorama(sides, pixels))
            }
            Lens::Panorama(_) => Self::flat(low, sides, pitch, steps_of_panorama(sides, pixels)),
        })
    }

    fn flat(low: [f64; 2], sides: [f64; 2], pitch: f64, steps: [f64; 2]) -> Self {
        // A pixel's surface reaches beyond its middle: half a cell around the outermost ones.
        let low = low.map(|v| v - 0.5 * pitch);
        let span = sides.map(|side| side / pitch + 1.0);
        let size = span.map(|cells| cells.ceil() as usize);
        Self { low, pitch, size, span, is_round: false, steps }
    }

    fn round(low: [f64; 2], sides: [f64; 2], pitch: f64, steps: [f64; 2]) -> Self {
        let columns = (TAU / pitch).round().max(1.0);
        let flat = Self::flat(low, sides, TAU / columns, steps);
        // None is outermost, and rounding would tell which is first where one is straight ahead, and in which cell
        // one is that is where two meet.
        let low = [-ASIDE * steps[0], flat.low[1]];
        Self { low, size: [columns as usize, flat.size[1]], is_round: true, ..flat }
    }

    /// How far apart the pixels of a camera are.
    pub(super) fn pixel(&self) -> f64 {
        self.pitch / CELL_PIXELS
    }

    pub(super) fn count(&self) -> usize {
        self.size[0] * self.size[1]
    }

    /// How many columns and rows of cells it takes to reach a pixel beside one.
    pub(super) fn reach(&self) -> [isize; 2] {
        self.steps.map(|step| (step / self.pitch).ceil().max(1.0) as isize)
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

    /// Which of all cells one is, row by row; `None` beside the view.
    pub(super) fn index(&self, x: isize, y: isize) -> Option<usize> {
        let x = if self.is_round { x.rem_euclid(self.size[0] as isize) } else { x };
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        (x < self.size[0] && y < self.size[1]).then_some(y * self.size[0] + x)
    }

    /// A cell and those around it, up to so many columns and rows away, each with how far right and below it is.
    pub(super) fn around(
        &self,
        [x, y]: [isize; 2],
        [columns, rows]: [isize; 2],
    ) -> impl Iterator<Item = ([isize; 2], usize)> {
        let aside = (-rows..=rows).flat_map(move |dy| (-columns..=columns).map(move |dx| [dx, dy]));
        aside.filter_map(move |[dx, dy]| Some(([dx, dy], self.index(x + dx, y + dy)?)))
    }
}

/// How wide cells are over such a part of a view with so many pixels.
fn pitch_over([width, height]: [f64; 2], pixels: f64) -> f64 {
    let area = width * height;
    (CELL_PIXELS * (area / pixels).sqrt())
        .max((area / MOST_CELLS).sqrt())
        .max(width.max(height) / MOST_COLUMNS)
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
