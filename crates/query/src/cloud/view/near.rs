//! Which points are about a place that a camera sees: told by its pixels, in a fraction of the time that a tree takes.

use cloudtouch_geom::{Point3, Vector3};

use super::lens::Lens;
pub(in crate::cloud) use super::lens::Spot;
use super::seeing::Seeing;

/// Points in a cell, about.
const IN_CELL: f64 = 4.0;
/// Cells along a side at most.
const MOST_CELLS: f64 = 1e4;

/// Points, by where a camera sees them.
#[derive(Debug)]
pub(in crate::cloud) struct ByPixels<'a> {
    lens: &'a Lens,
    low: [f64; 2],
    pitch: f64,
    /// Columns and rows.
    size: [usize; 2],
    /// The points of a cell are these from its own start to the next.
    indices: Vec<u32>,
    starts: Vec<u32>,
}

impl<'a> Seeing<'a> {
    /// Points by its pixels; `None` of a panorama, and where some are not ahead.
    pub(in crate::cloud) fn by_pixels(&self, points: &[Point3]) -> Option<ByPixels<'a>> {
        ByPixels::new(&self.raster.lens, self.image.sensor_origin, points)
    }
}

impl<'a> ByPixels<'a> {
    fn new(lens: &'a Lens, camera: Point3, points: &[Point3]) -> Option<Self> {
        let Lens::Camera(_) = lens else { return None };
        let places: Option<Vec<[f64; 2]>> =
            points.iter().map(|point| lens.project(&(point - camera))).collect();
        let places = places?;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for (at, axis) in places.iter().flat_map(|at| [(at, 0), (at, 1)]) {
            low[axis] = low[axis].min(at[axis]);
            high[axis] = high[axis].max(at[axis]);
        }
        let extent = [high[0] - low[0], high[1] - low[1]];
        let pitch = (IN_CELL * extent[0] * extent[1] / places.len() as f64).sqrt();
        let pitch = pitch.max(extent[0].max(extent[1]) / MOST_CELLS);
        if !(pitch > 0.0 && pitch.is_finite()) {
            return None;
        }
        let size = extent.map(|side| (side / pitch) as usize + 1);
        let mut cells = Self { lens, low, pitch, size, indices: Vec::new(), starts: Vec::new() };
        let cell = |at: &[f64; 2]| {
            let [x, y] = [0, 1].map(|axis| cells.steps(at[axis], axis) as usize);
            y * size[0] + x
        };
        let of_points: Vec<usize> = places.iter().map(cell).collect();
        // Counted, summed up, and handed out from the last on.
        let mut starts = vec![0_u32; size[0] * size[1] + 1];
        of_points.iter().for_each(|&cell| starts[cell] += 1);
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        let mut indices = vec![0; places.len()];
        for (index, &cell) in of_points.iter().enumerate().rev() {
            starts[cell] -= 1;
            indices[starts[cell] as usize] = index as u32;
        }
        (cells.starts, cells.indices) = (starts, indices);
        Some(cells)
    }

    /// Where the camera sees what a ray leads to; `None` of what is not ahead.
    pub(in crate::cloud) fn spot(&self, ray: &Vector3) -> Option<Spot> {
        self.lens.spot(ray)
    }

    /// Calls `visit` with all points no farther than a distance (m) from a place that is seen at a spot, or from any
    /// that is seen there farther away, and with others; `false` without it where some of them may not be ahead.
    pub(in crate::cloud) fn visit_about(
        &self,
        spot: Spot,
        distance: f64,
        mut visit: impl FnMut(usize),
    ) -> bool {
        let Some(reach) = spot.reach(distance) else { return false };
        let mut spans = [[0; 2]; 2];
        for axis in 0..2 {
            let [from, to] =
                [-1.0, 1.0].map(|sign| self.steps(spot.at[axis] + sign * reach[axis], axis));
            if to < 0.0 || from >= self.size[axis] as f64 {
                return true;
            }
            spans[axis] = [from.max(0.0) as usize, (to as usize).min(self.size[axis] - 1)];
        }
        let [[left, right], [top, bottom]] = spans;
        for row in top..=bottom {
            let first = row * self.size[0];
            let [from, to] =
                [first + left, first + right + 1].map(|cell| self.starts[cell] as usize);
            self.indices[from..to].iter().for_each(|&index| visit(index as usize));
        }
        true
    }

    /// Whole cells from the first of a row or a column to a place.
    fn steps(&self, at: f64, axis: usize) -> f64 {
        ((at - self.low[axis]) / self.pitch).floor()
    }
}
