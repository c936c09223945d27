//! Where a surface is between the pixels that met it.
//!
//! A floor that is seen aslant recedes by more from one row of pixels to the next than a hand is thick, and what lies
//! between two rows is neither as near as the one nor as far as the other. On a plane one over the distance goes evenly
//! over the view: along the axis of a camera for all of it, from a scanner over so few cells.

/// How many cells away those about one are that are fitted with it.
pub(super) const REACH: isize = 1;
/// Cells that are fitted, at most and at least.
const MOST: usize = (2 * REACH as usize + 1).pow(2);
const LEAST: usize = 4;
/// Cells are no plane where one is farther from it than their noise and this part of what they differ by.
const BENT: f64 = 0.05;
/// What is fitted has no slope one way where its cells are all but on a line: of means of even cells it is some .03.
const LINE: f64 = 1e-3;

/// What was met in a cell: in the mean, from its middle in cells, and one over how far away, 1/m.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Mean {
    at: [f32; 2],
    inverse: f32,
    count: f32,
}

impl Mean {
    /// Takes a return: where it is from the middle of the cell, in cells, and how far away, m.
    pub(super) fn add(&mut self, at: [f64; 2], distance: f64) {
        self.count += 1.0;
        let share = self.count.recip();
        for (mean, new) in self.at.iter_mut().zip(at) {
            *mean += (new as f32 - *mean) * share;
        }
        self.inverse += (distance.recip() as f32 - self.inverse) * share;
    }
}

/// Cells about one, and what they say of the plane that they lie on.
#[derive(Debug, Default)]
pub(super) struct Surface {
    /// Each by where it is, in cells, one over how far away, 1/m, and how many returns it has.
    cells: [([f64; 2], f64, f64); MOST],
    count: usize,
}

impl Surface {
    /// Takes a cell that is so many cells aside.
    pub(super) fn add(&mut self, aside: [isize; 2], mean: Mean) {
        if mean.count > 0.0 {
            let at = [0, 1].map(|axis| f64::from(mean.at[axis]) + aside[axis] as f64);
            self.cells[self.count] = (at, f64::from(mean.inverse), f64::from(mean.count));
            self.count += 1;
        }
    }

    /// How far away, m, the plane is at a place from the middle of the one, in cells, returns being known this well, m;
    /// `None` where the cells are on none.
    pub(super) fn distance(&self, clear: f64, at: [f64; 2]) -> Option<f64> {
        let cells = &self.cells[..self.count];
        // In the mean: the middle of all, and second moments about it.
        let mut sums = [0.0; 4];
        let (mut near, mut far) = (0.0_f64, f64::INFINITY);
        for ([x, y], inverse, weight) in cells {
            sums = [
                sums[0] + weight,
                sums[1] + weight * x,
                sums[2] + weight * y,
                sums[3] + weight * inverse,
            ];
            (near, far) = (near.max(*inverse), far.min(*inverse));
        }
        let [weight, x, y, inverse] = sums;
        let middle = [x / weight, y / weight, inverse / weight];
        let from_middle = |at: &[f64; 2]| [at[0] - middle[0], at[1] - middle[1]];
        let (mut xx, mut xy, mut yy, mut xi, mut yi) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (at, inverse, share) in cells {
            let ([x, y], inverse, share) = (from_middle(at), inverse - middle[2], share / weight);
            (xx, xy, yy) = (xx + share * x * x, xy + share * x * y, yy + share * y * y);
            (xi, yi) = (xi + share * x * inverse, yi + share * y * inverse);
        }
        let determinant = xx * yy - xy * xy;
        if self.count < LEAST || determinant < LINE {
            return None;
        }
        let slope = [(yy * xi - xy * yi) / determinant, (xx * yi - xy * xi) / determinant];
        let on_plane = |at: &[f64; 2]| {
            let [x, y] = from_middle(at);
            middle[2] + slope[0] * x + slope[1] * y
        };
        let off = clear * near * near + BENT * (near - far);
        let is_plane = cells.iter().all(|(at, inverse, _)| (on_plane(at) - inverse).abs() <= off);
        is_plane.then(|| on_plane(&at).clamp(far, near).recip())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells with so many rows and columns of returns each, of a surface this far away at a place from the middle one.
    fn cells(
        [columns, rows]: [usize; 2],
        surface: impl Fn([f64; 2]) -> f64 + Copy,
    ) -> impl Iterator<Item = ([isize; 2], Mean)> {
        (-1..=1).flat_map(move |dy| (-1..=1).map(move |dx| [dx, dy])).map(move |aside| {
            let mut mean = Mean::default();
            for (row, column) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
                let place = |k: usize, count: usize| (k as f64 + 0.5) / count as f64 - 0.5;
                let at = [place(column, columns), place(row, rows)];
                mean.add(at, surface([0, 1].map(|k| at[k] + aside[k] as f64)));
            }
            (aside, mean)
        })
    }

    fn surface_of(cells: impl Iterator<Item = ([isize; 2], Mean)>) -> Surface {
        let mut surface = Surface::default();
        cells.for_each(|(aside, mean)| surface.add(aside, mean));
        surface
    }

    #[test]
    fn on_a_floor_it_is_the_floor_wherever_the_rows_are() {
        let floor = |[x, y]: [f64; 2]| 1.0 / (0.5 - 0.03 * y + 0.01 * x);
        for counts in [[2, 2], [4, 1], [1, 3]] {
            for at in [[0.0, 0.0], [0.4, -0.5], [-0.5, 0.3]] {
                let found = surface_of(cells(counts, floor)).distance(0.0, at).unwrap();
                assert!((found / floor(at) - 1.0).abs() < 1e-6, "{counts:?} {at:?}: {found}");
            }
        }
    }

    #[test]
    fn past_a_rim_and_where_a_floor_meets_a_wall_nothing_is_known() {
        let rim = |[x, _]: [f64; 2]| if x < 0.6 { 1.0 } else { 2.0 };
        let corner = |[_, y]: [f64; 2]| 1.0 / (0.5 - 0.03 * y.min(0.0));
        assert_eq!(surface_of(cells([2, 2], rim)).distance(0.01, [0.0; 2]), None);
        assert_eq!(surface_of(cells([2, 2], corner)).distance(0.01, [0.0; 2]), None);
    }

    #[test]
    fn a_line_of_cells_has_no_plane_and_no_cell_is_farther_than_those_about_it() {
        let floor = |[_, y]: [f64; 2]| 1.0 / (0.5 - 0.1 * y);
        let on_a_line = cells([2, 2], floor).filter(|(aside, _)| aside[0] == 0);
        let above = cells([2, 2], floor).filter(|(aside, _)| aside[1] > -1);
        assert_eq!(surface_of(on_a_line).distance(0.0, [0.0; 2]), None);
        assert_eq!(surface_of(above).distance(0.0, [0.0, -3.0]), Some(2.0));
    }
}
