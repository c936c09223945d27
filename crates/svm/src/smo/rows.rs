//! Kernel rows, computed when a step first needs them and kept while they fit.

use std::collections::VecDeque;

use crate::lanes::{Lane, WIDTH};
use crate::problem::Problem;

/// Rows of the reduced scalar kernel matrix; the oldest row goes when memory is full.
#[derive(Debug, Default)]
pub(crate) struct KernelRows {
    /// Rows one after another, each as many lanes as hold the samples.
    values: Vec<Lane>,
    /// Which row of `values` a sample has.
    place: Vec<Option<usize>>,
    /// The samples that have a row, oldest first.
    kept: VecDeque<usize>,
    /// Lanes of a row.
    lanes: usize,
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
        self.lanes = problem.len().div_ceil(WIDTH);
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
        let place = self.free_place((BUDGET / problem.len()).max(2), other);
        let range = place * self.lanes..(place + 1) * self.lanes;
        if self.values.len() < range.end {
            self.values.resize(range.end, Lane::ZERO);
        }
        let row = &mut self.values[range];
        problem.kernel.reduced_row(&problem.points[i].x, &problem.places, row);
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
    pub(crate) fn row(&self, i: usize) -> &[Lane] {
        let lanes = self.lanes;
        self.place[i].map_or(&[], |place| &self.values[place * lanes..(place + 1) * lanes])
    }

    /// The reduced kernel of two samples, the row of the first of which has been ensured.
    pub(crate) fn at(&self, i: usize, j: usize) -> f64 {
        self.row(i)[j / WIDTH].0[j % WIDTH]
    }

    pub(crate) fn computed(&self) -> usize {
        self.computed
    }
}
