//! A surface over two numbers: values at knots, and straight lines between them.

/// Values at the knots of two axes, the first by rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid<'a, const N: usize, const M: usize> {
    pub rows: &'a [f64; N],
    pub columns: &'a [f64; M],
    pub values: &'a [[f64; M]; N],
}

impl<const N: usize, const M: usize> Grid<'_, N, M> {
    /// Bilinear between the knots around a place, as at the border beyond it: continuous, and
    /// monotone where the values are.
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        let ((i, s), (j, t)) = (between_knots(self.rows, x), between_knots(self.columns, y));
        let along = |row: &[f64; M]| row[j] + t * (row[j + 1] - row[j]);
        let (low, high) = (along(&self.values[i]), along(&self.values[i + 1]));
        low + s * (high - low)
    }

    /// What [`Self::at`] changes by with each number; nothing at and beyond the border, and at a knot
    /// what it changes by above it.
    pub(super) fn slopes(&self, x: f64, y: f64) -> [f64; 2] {
        let ((i, s), (j, t)) = (between_knots(self.rows, x), between_knots(self.columns, y));
        let inside = |knots: &[f64], at: f64| knots[0] < at && at < knots[knots.len() - 1];
        let [[a, b], [c, d]] = [i, i + 1].map(|i| [self.values[i][j], self.values[i][j + 1]]);
        let by_row = (c - a + t * (d - c - b + a)) / (self.rows[i + 1] - self.rows[i]);
        let by_column = (b - a + s * (d - c - b + a)) / (self.columns[j + 1] - self.columns[j]);
        [
            if inside(self.rows, x) { by_row } else { 0.0 },
            if inside(self.columns, y) { by_column } else { 0.0 },
        ]
    }
}

/// Between which two of ascending knots a number falls, by the index of the first, and how far along
/// from it to the next, from 0 to 1; beyond the border as at the border. A [`Judge`](crate::Judge) reads
/// its values so, and who fits one of their own has to.
///
/// # Panics
/// With fewer than two knots.
pub fn between_knots(knots: &[f64], x: f64) -> (usize, f64) {
    let last = knots.len() - 2;
    let i = knots.partition_point(|&knot| knot <= x).saturating_sub(1).min(last);
    let share = (x - knots[i]) / (knots[i + 1] - knots[i]);
    (i, share.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    const GRID: Grid<'_, 2, 3> = Grid {
        rows: &[0.0, 2.0],
        columns: &[0.0, 1.0, 3.0],
        values: &[[0.0, 1.0, 2.0], [4.0, 5.0, 8.0]],
    };

    #[test]
    fn knots_have_their_values_and_places_between_them_the_mean() {
        for (i, &x) in GRID.rows.iter().enumerate() {
            for (j, &y) in GRID.columns.iter().enumerate() {
                assert_eq!(GRID.at(x, y), GRID.values[i][j]);
            }
        }
        assert_eq!(GRID.at(1.0, 0.5), 2.5);
        assert_eq!(GRID.at(1.0, 2.0), 4.0);
    }

    #[test]
    fn slopes_are_what_a_step_changes() {
        for (x, y) in [(0.7, 0.2), (1.9, 2.9), (0.1, 1.4), (3.0, 1.5), (1.0, -1.0), (-1.0, 9.0)] {
            let [by_row, by_column] = GRID.slopes(x, y);
            let change = |dx: f64, dy: f64| GRID.at(x + dx, y + dy) - GRID.at(x - dx, y - dy);
            assert!((by_row - change(1e-3, 0.0) / 2e-3).abs() < 1e-9, "{x} {y}");
            assert!((by_column - change(0.0, 1e-3) / 2e-3).abs() < 1e-9, "{x} {y}");
        }
    }

    #[test]
    fn beyond_the_border_nothing_changes() {
        assert_eq!(GRID.at(-9.0, 99.0), 2.0);
        assert_eq!(GRID.at(f64::INFINITY, f64::NEG_INFINITY), 4.0);
    }
}
