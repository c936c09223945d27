//! Kernel rows, computed when a step first needs them and kept while they fit.

use std::collections::VecDeque;

use crate::problem::Problem;

/// Rows of the reduced scalar kernel matrix; the oldest row goes when memory is full.
#[derive(Debug, Default)]
pub(crate) struct KernelRows {
    /// Rows one after another, as long as there are samples.
    values: Vec<f64>,
    /// Which row of `values` a sample has.
    place: Vec<Option<usize>>,
    /// The samples that have a row, oldest first.
    kept: VecDeque<usize>,
    computed: usize,
}

/// Memory for rows, in numbers (64 MiB); at least two rows are kept whatever their length.
const BUDGET: usize = 8 << 20;

impl KernelRows {
    /// Forgets everything but the memory, for another problem.
    pub(crate) fn reset(&mut self, problem: &Problem) {
        self.values.clear();
        self.kept.clear();
        self.computed = 0;
        self.place.clear();
        self.place.resize(problem.len(), None);
    }

    /// Makes row `i` available.
    pub(crate) fn ensure(&mut self, problem: &Problem, i: usize) {
        self.ensure_beside(problem, i, i);
    }

    /// Makes row `i` available without dropping row `other`.
    pub(crate) fn ensure_beside(&mut self, problem: &Problem, i: usize, other: usize) {
        if self.place[i].is_some() {
            return;
        }
        let n = problem.len();
        let place = self.free_place((BUDGET / n).max(2), other);
        if self.values.len() < (place + 1) * n {
            self.values.resize((place + 1) * n, 0.0);
        }
        let x = &problem.points[i].x;
        let row = &mut self.values[place * n..(place + 1) * n];
        for (value, point) in row.iter_mut().zip(&problem.points) {
            *value = problem.kernel.reduced(x, &point.x);
        }
        self.place[i] = Some(place);
        self.kept.push_back(i);
        self.computed += 1;
    }

    fn free_place(&mut self, capacity: usize, spare: usize) -> usize {
        if self.kept.len() >= capacity {
            let oldest = usize::from(self.kept.front() == Some(&spare));
            if let Some(place) = self.kept.remove(oldest).and_then(|row| self.place[row].take()) {
                return place;
            }
        }
        self.kept.len()
    }

    /// Row `i`; empty unless it has been ensured.
    pub(crate) fn row(&self, i: usize) -> &[f64] {
        let n = self.place.len();
        self.place[i].map_or(&[], |place| &self.values[place * n..(place + 1) * n])
    }

    pub(crate) fn computed(&self) -> usize {
        self.computed
    }
}
