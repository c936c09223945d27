//! Kernel rows, computed when a step first needs them and kept while they fit.

use std::collections::VecDeque;

use crate::problem::Problem;

/// Rows of the scalar kernel matrix; the oldest row goes when memory is full.
pub(crate) struct KernelRows {
    rows: Vec<Option<Box<[f64]>>>,
    diagonal: Vec<f64>,
    kept: VecDeque<usize>,
    capacity: usize,
    computed: usize,
}

/// Memory for rows, in numbers (64 MiB); at least two rows are kept whatever their length.
const BUDGET: usize = 8 << 20;

impl KernelRows {
    pub(crate) fn new(problem: &Problem) -> Self {
        let n = problem.len();
        Self {
            rows: vec![None; n],
            diagonal: problem.points.iter().map(|p| problem.kernel.value(&p.x, &p.x)).collect(),
            kept: VecDeque::new(),
            capacity: (BUDGET / n).max(2),
            computed: 0,
        }
    }

    /// Makes row `i` available.
    pub(crate) fn ensure(&mut self, problem: &Problem, i: usize) {
        self.ensure_beside(problem, i, i);
    }

    /// Makes row `i` available without dropping row `other`.
    pub(crate) fn ensure_beside(&mut self, problem: &Problem, i: usize, other: usize) {
        if self.rows[i].is_some() {
            return;
        }
        while self.kept.len() >= self.capacity {
            match self.kept.pop_front() {
                Some(oldest) if oldest == other => self.kept.push_back(oldest),
                Some(oldest) => self.rows[oldest] = None,
                None => break,
            }
        }
        let x = &problem.points[i].x;
        self.rows[i] = Some(problem.points.iter().map(|p| problem.kernel.value(x, &p.x)).collect());
        self.kept.push_back(i);
        self.computed += 1;
    }

    /// Row `i`; empty unless it has been ensured.
    pub(crate) fn row(&self, i: usize) -> &[f64] {
        self.rows[i].as_deref().unwrap_or(&[])
    }

    pub(crate) fn diagonal(&self, i: usize) -> f64 {
        self.diagonal[i]
    }

    pub(crate) fn computed(&self) -> usize {
        self.computed
    }
}
