//! How far a panorama saw between its lines.
//!
//! Lines of a turning scanner may be far apart: on a floor that is seen aslant, decimetres. What lies between two of
//! them is taken for straight, as the floor is: there one over the range goes evenly with the elevation.

/// The returns of a line differ by less than this part of what parts lines in the mean; of some scanners those in the
/// middle are a quarter of it apart.
const ONE_LINE: f64 = 0.1;

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
        let is_of =
            |line: &Met| f64::from((met.elevation - line.elevation).abs()) < ONE_LINE * self.step;
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
    /// from its own on; `None` where one of the two is not in them.
    pub(super) fn behind(
        &self,
        elevation: f64,
        down: impl Iterator<Item = usize>,
        up: impl Iterator<Item = usize>,
    ) -> Option<f64> {
        let at = elevation as f32;
        let met = |cell: usize| self.cells[cell].into_iter().flatten();
        let below = down.flat_map(|cell| met(cell).rev()).find(|met| met.elevation <= at)?;
        let above = up.flat_map(met).find(|met| met.elevation > at)?;
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
        let behind = |elevation: f64, first: usize| {
            let own = ((elevation + 0.295) / 0.03) as usize;
            lines.behind(elevation, (first..=own).rev(), own..3)
        };
        for elevation in [-0.27, -0.26, -0.245, -0.23] {
            let found = behind(elevation, 0).unwrap();
            assert!((found / range(elevation) - 1.0).abs() < 0.005, "{elevation}: {found}");
        }
        assert_eq!(behind(-0.21, 0), None);
        assert_eq!(behind(-0.29, 0), None);
        assert_eq!(behind(-0.23, 1), None);
    }
}
