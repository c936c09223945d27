//! How far a camera saw in each direction of its view.
//!
//! Directions are looked up in a raster over the view, of cells two pixels wide, and not among the
//! measured directions: a query looks at hundreds of them.

use std::f64::consts::TAU;

use cloudtouch_geom::{Point3, Vector3};
use nalgebra::UnitQuaternion;

use super::lines::Lines;

/// Edge of a raster's cell in pixels: no cell between measured pixels is left empty by chance.
const CELL_PIXELS: f64 = 2.0;
/// A place is in a hole when nothing was measured so many cells around its own: every hole eight pixels wide has
/// such places, and smaller ones are specks that hardly a surface hides in.
const HOLE_CELLS: isize = 1;
/// Standard deviations of the measured surface that count as clearly behind it.
pub(in crate::cloud) const CLEARLY: f64 = 3.0;
/// An image with a direction so far off its middle (cosine) is a panorama: 80° and more.
const PANORAMA: f64 = 0.17;
/// A surface recedes across a cell when it did so before it at this part of the rate: of two directions one has half.
const STEADY: f64 = 0.4;
/// What is no farther behind a return, m, may be inside the thing it came from: few things on a table are thicker.
const CLOSE: f64 = 0.03;
/// Lines that are farther apart than so many of their pixels are lines.
const APART: f64 = 1.5;
/// One that lacks no more cells than that of a full turn goes all around.
const LEAST_GAP_CELLS: f64 = 2.0;
/// Cells of a raster at most, and columns or rows: beyond, they become wider.
const MOST_CELLS: f64 = 1e7;
const MOST_COLUMNS: f64 = 1e4;

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

/// How far was seen in each direction of a view.
#[derive(Debug)]
pub(super) struct Raster {
    pub(super) lens: Lens,
    low: [f64; 2],
    pitch: f64,
    /// Columns and rows.
    size: [usize; 2],
    /// Cells up to half of one past the outermost pixels: the last of a row or a column may reach beyond.
    span: [f64; 2],
    /// Whether the last column is beside the first.
    is_round: bool,
    /// How many columns and rows of cells it takes to reach a pixel beside one.
    pub(super) reach: [isize; 2],
    /// The range, m, clearly behind the farthest return of each cell; zero without one.
    pub(super) clearly_behind: Vec<f64>,
    /// The range, m, clearly behind the nearest return of each cell; infinite without one.
    pub(super) behind_nearest: Vec<f64>,
    /// The range, m, clearly before the nearest return of each cell; infinite without one.
    pub(super) clearly_before: Vec<f64>,
    /// Of each cell whether what is farther was left out; empty where nothing was.
    is_open: Vec<bool>,
    /// Of a panorama whose lines are farther apart than the pixels of one.
    lines: Option<Lines>,
}

impl Raster {
    /// Of the points measured, each with an upper bound of its standard deviations, m, in so many pixels, and of
    /// rays `beyond` which returns were left out.
    ///
    /// Cells are as large as pixels are, however many of these have no return: by the returns alone holes
    /// would be the smaller the more of them there are.
    pub(super) fn new(
        (origin, turn): (&Point3, &UnitQuaternion<f64>),
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
        let lens = Lens::of(rays.iter().map(|(ray, range, _)| (ray, *range)), turn)?;
        let place = |(number, (ray, range, clear)): (usize, &(Vector3, f64, f64))| {
            Some((number, [range - clear, range + clear], lens.project(ray)?))
        };
        let placed: Vec<_> = rays.iter().enumerate().filter_map(place).collect();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (_, _, at) in &placed {
            for axis in 0..2 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
        }
        let extent = [high[0] - low[0], high[1] - low[1]];
        let area = extent[0] * extent[1];
        let pitch = (CELL_PIXELS
            * (area / (pixels[0] * pixels[1]).max(placed.len()).max(1) as f64).sqrt())
        .max((area / MOST_CELLS).sqrt())
        .max(extent[0].max(extent[1]) / MOST_COLUMNS);
        if !(pitch > 0.0 && pitch.is_finite()) {
            return None;
        }
        let is_round =
            matches!(lens, Lens::Panorama(_)) && extent[0] + LEAST_GAP_CELLS * pitch > TAU;
        let columns = (TAU / pitch).floor().max(1.0);
        let pitch = if is_round { TAU / columns } else { pitch };
        // A pixel's surface reaches beyond its middle: half a cell around the outermost ones.
        let low = low.map(|v| v - 0.5 * pitch);
        let span = extent.map(|side| side / pitch + 1.0);
        let mut size = span.map(|cells| cells.ceil() as usize);
        if is_round {
            size[0] = columns as usize;
        }
        let cells = size[0] * size[1];
        let steps = match lens {
            Lens::Camera(_) => [pitch / CELL_PIXELS; 2],
            Lens::Panorama(_) => steps_of_panorama(extent, pixels),
        };
        let reach = steps.map(|step| (step / pitch).ceil().max(1.0) as isize);
        let (clearly_behind, clearly_before) = (vec![0.0; cells], vec![f64::INFINITY; cells]);
        let is_open = vec![false; if beyond.is_empty() { 0 } else { cells }];
        let mut raster = Self {
            lens,
            low,
            pitch,
            size,
            span,
            is_round,
            reach,
            clearly_behind,
            behind_nearest: vec![f64::INFINITY; cells],
            clearly_before,
            is_open,
            lines: (steps[1] > APART * steps[0]).then(|| Lines::new(cells, steps[1])),
        };
        for (number, [before, behind], at) in placed {
            if let Some(cell) = raster.cell(at).and_then(|[x, y]| raster.index(x, y)) {
                raster.clearly_behind[cell] = raster.clearly_behind[cell].max(behind);
                raster.behind_nearest[cell] = raster.behind_nearest[cell].min(behind);
                raster.clearly_before[cell] = raster.clearly_before[cell].min(before);
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

    pub(super) fn sight(&self, ray: &Vector3) -> Sight {
        if self.lens.is_behind(ray) {
            return Sight::BehindCamera;
        }
        let place = self.lens.project(ray).and_then(|at| Some((at, self.cell(at)?)));
        let Some((at, [x, y])) = place else {
            return Sight::OutsideView;
        };
        let range = ray.norm();
        let is_behind_lines =
            || self.behind_lines(at[1], [x, y]).is_some_and(|behind| range > behind);
        // The nearest ring of cells with a return tells: of the cell itself the nearest return that a surface may end
        // at, since what hides behind the rim of something is behind part of a cell only; of those around, across specks,
        // the farthest.
        for ring in 0..=HOLE_CELLS {
            let (mut farthest, mut is_open) = (0.0_f64, false);
            for dy in -ring..=ring {
                let step = if dy.abs() == ring { 1 } else { 2 * ring.max(1) };
                for dx in (-ring..=ring).step_by(step as usize) {
                    if let Some(cell) = self.index(x + dx, y + dy) {
                        let behind = self.clearly_behind[cell];
                        let told = if ring == 0 { self.behind_rim(range, [x, y]) } else { behind };
                        farthest = farthest.max(told);
                        is_open |= self.is_open.get(cell).is_some_and(|&is_open| is_open);
                    }
                }
            }
            if farthest > 0.0 {
                return match range > farthest {
                    true if is_open => Sight::OutOfRange,
                    true if self.is_close_behind(range, [x, y]) => Sight::CloseBehind,
                    true => Sight::BehindReturns,
                    false if is_behind_lines() => Sight::BehindReturns,
                    false => Sight::Seen,
                };
            }
        }
        Sight::Hole
    }

    /// The range behind which something is hidden by part of a cell at least: behind the nearest return there, unless a
    /// surface recedes from before the cell to beyond it.
    fn behind_rim(&self, range: f64, [x, y]: [isize; 2]) -> f64 {
        let Some(cell) = self.index(x, y) else { return 0.0 };
        let [nearest, farthest] = [self.behind_nearest[cell], self.clearly_behind[cell]];
        let recedes = || {
            let before = nearest - STEADY * (farthest - nearest);
            let beside =
                [[1, 0], [-1, 0], [0, 1], [0, -1]].map(|[dx, dy]| self.index(x + dx, y + dy));
            beside.into_iter().flatten().any(|cell| self.behind_nearest[cell] <= before)
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
        let behind = self.index(x, y).map_or(0.0, |cell| self.clearly_behind[cell]);
        range > behind && range <= behind + CLOSE
    }

    /// The range clearly behind what two lines of a panorama have between them, where these are next to one another.
    fn behind_lines(&self, elevation: f64, [x, y]: [isize; 2]) -> Option<f64> {
        let rows = self.reach[1];
        let cells = (y - rows..=y + rows).filter_map(|y| self.index(x, y));
        self.lines.as_ref()?.behind(elevation, cells)
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

/// How directions become places of a view.
#[derive(Debug)]
pub(super) enum Lens {
    /// A camera: forward is where the points lie, right and down are as nearly as can be those of its rows and
    /// columns, so that its view is a rectangle of the raster in every frame.
    Camera([Vector3; 3]),
    /// All around the vertical of the sensor: by azimuth and elevation, from its frame.
    Panorama(UnitQuaternion<f64>),
}

impl Lens {
    /// Of rays and how long they are, m.
    fn of<'a>(
        rays: impl Iterator<Item = (&'a Vector3, f64)> + Clone,
        turn: &UnitQuaternion<f64>,
    ) -> Option<Self> {
        let rays = || rays.clone().filter(|(_, range)| *range > 0.0);
        let directions = rays().map(|(ray, range)| ray / range);
        let forward = directions.sum::<Vector3>().try_normalize(0.0)?;
        if rays().any(|(ray, range)| ray.dot(&forward) < PANORAMA * range) {
            return Some(Self::Panorama(turn.inverse()));
        }
        // A camera looks along its z; one whose turn is stated otherwise, as in a frame with x forward, still has
        // an axis aside.
        let local = turn.inverse_transform_vector(&forward);
        let right = if local.x.abs() < local.z.abs() { Vector3::x() } else { Vector3::y() };
        let down = forward.cross(&turn.transform_vector(&right)).normalize();
        Some(Self::Camera([down.cross(&forward), down, forward]))
    }

    fn is_behind(&self, ray: &Vector3) -> bool {
        match self {
            Self::Camera([_, _, forward]) => ray.dot(forward) <= 0.0,
            Self::Panorama(_) => false,
        }
    }

    /// `None` for a direction that no view of this kind has.
    pub(super) fn project(&self, ray: &Vector3) -> Option<[f64; 2]> {
        match self {
            Self::Camera([right, down, forward]) => {
                let depth = ray.dot(forward);
                (depth > 0.0).then(|| [ray.dot(right) / depth, ray.dot(down) / depth])
            }
            Self::Panorama(to_sensor) => {
                let (range, ray) = (ray.norm(), to_sensor.transform_vector(ray));
                (range > 0.0).then(|| [ray.y.atan2(ray.x).rem_euclid(TAU), (ray.z / range).asin()])
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        Raster::new((&Point3::origin(), &turn), (0..360 * 41).map(ray), &[], [360, 41]).unwrap()
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
            let raster = Raster::new((&Point3::origin(), &turn), measured, &[], [40, 30]).unwrap();
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
