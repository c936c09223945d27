//! The dense quadratic form of the dual, for the interior point methods.

use cloudtouch_geom::Vector3;
use faer::Mat;

use crate::problem::Problem;

/// Dual variables beyond which the dense matrix is not built (46 MB, and seconds an iteration).
const MAX_VARIABLES: usize = 2400;

/// One scalar variable of the dual: a multiplier, or a component of a cone vector.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Variable {
    pub(crate) point: usize,
    /// `None` for α, the eigen-axis for a component of p.
    pub(crate) axis: Option<usize>,
}

impl Variable {
    /// Its place in (α, p).
    pub(crate) fn slot(&self) -> usize {
        self.axis.map_or(0, |axis| axis + 1)
    }
}

/// The variables of the dual; axes without variance have none.
pub(crate) fn variables(problem: &Problem) -> Vec<Variable> {
    let mut all = Vec::new();
    for (index, point) in problem.points.iter().enumerate() {
        all.push(Variable { point: index, axis: None });
        let axes = (0..3).filter(|&axis| point.t[axis] > 0.0);
        all.extend(axes.map(|axis| Variable { point: index, axis: Some(axis) }));
    }
    all
}

/// The Gram matrix B of the dual's quadratic form (full, symmetric); `None` when it is too large.
pub(crate) fn gram(problem: &Problem, variables: &[Variable]) -> Option<Mat<f64>> {
    if variables.len() > MAX_VARIABLES {
        return None;
    }
    let terms: Vec<(f64, Vector3)> = variables
        .iter()
        .map(|v| {
            let point = &problem.points[v.point];
            match v.axis {
                None => (point.sign, Vector3::zeros()),
                Some(axis) => (0.0, point.factor.row(axis).transpose()),
            }
        })
        .collect();
    let n = variables.len();
    let mut matrix = Mat::zeros(n, n);
    for column in 0..n {
        let from = &problem.points[variables[column].point].x;
        let (a, s) = &terms[column];
        let mut last = None;
        let mut felt = (0.0, Vector3::zeros());
        for row in 0..=column {
            let target = variables[row].point;
            if last != Some(target) {
                let to = &problem.points[target].x;
                felt = problem.kernel.influence(from, to, problem.kernel.value(from, to), *a, s);
                last = Some(target);
            }
            let value = terms[row].0 * felt.0 + terms[row].1.dot(&felt.1);
            matrix[(row, column)] = value;
            matrix[(column, row)] = value;
        }
    }
    Some(matrix)
}
