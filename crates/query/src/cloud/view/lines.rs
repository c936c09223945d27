//! How far a panorama saw between its lines.
//!
//! Lines of a turning scanner may be far apart: on a floor that is seen aslant, decimetres. What lies between two of
//! them is taken for straight, as the floor is: there one over the range goes evenly with the elevation.

/// What is known of a line in a cell: its elevation, rad, and the range, m, clearly behind its farthest return.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Met {
    elevation: f32,
    behind: f32,
}

/// The lowest and the highest line in each cell of a raster.
#[derive(Debug)]
pub(super) struct Lines {
    cells: Vec<Option<[Met; 2]>>,
    /// How far apart lines are, rad.
    step: f64,
}

impl Lines {
    pub(super) fn new(cells: usize, step: f64) -> Self {
        Self { cells: vec![None; cells], step }
    }

    /// Takes a return into a cell.
    pub(super) fn add(&mut self, cell: usize, elevation: f64, behind: f64) {
        let met = Met { elevation: elevation as f32, behind: behind as f32 };
        let Some([low, high]) = &mut self.cells[cell] else {
            self.cells[cell] = Some([met; 2]);
            return;
        };
        // Those of one line differ by less than half of what parts lines.
        let is_of =
            |line: &Met| f64::from((met.elevation - line.elevation).abs()) < 0.5 * self.step;
        let is_low = is_of(low);
        for line in [&mut *low, &mut *high] {
            if is_of(line) {
                line.behind = line.behind.max(met.behind);
            }
        }
        if !is_low && met.elevation < low.elevation {
            *low = met;
        }
        if met.elevation > high.elevation && !is_of(high) {
            *high = met;
        }
    }

    /// The range clearly behind what lies at an elevation, between the lines next below and above it in these cells,
    /// from the lowest on; `None` where one of the two is not in them.
    pub(super) fn behind(&self, elevation: f64, cells: impl Iterator<Item = usize>) -> Option<f64> {
        let at = elevation as f32;
        let (mut below, mut above) = (None::<Met>, None::<Met>);
        for met in cells.filter_map(|cell| self.cells[cell]).flatten() {
            if met.elevation <= at {
                below = Some(met);
            } else if above.is_none() {
                above = Some(met);
            }
        }
        let (below, above) = (below?, above?);
        let part = (at - below.elevation) / (above.elevation - below.elevation);
        let inverse = (1.0 - part) / below.behind + part / above.behind;
        Some(f64::from(inverse.recip()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_two_lines_on_a_floor_is_the_floor() {
        let range = |elevation: f64| 1.5 / (-elevation).sin();
        let mut lines = Lines::new(3, 0.03);
        for (cell, elevation) in [(0, -0.28), (0, -0.25), (2, -0.22)] {
            lines.add(cell, elevation, range(elevation));
            // Beside it, a little lower and not as far.
            lines.add(cell, elevation - 0.001, 0.5 * range(elevation));
        }
        for elevation in [-0.27, -0.26, -0.245, -0.23] {
            let found = lines.behind(elevation, 0..3).unwrap();
            assert!((found / range(elevation) - 1.0).abs() < 0.005, "{elevation}: {found}");
        }
        assert_eq!(lines.behind(-0.21, 0..3), None);
        assert_eq!(lines.behind(-0.29, 0..3), None);
        assert_eq!(lines.behind(-0.23, 1..3), None);
    }
}
