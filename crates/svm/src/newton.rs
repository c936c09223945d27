//! The linear system of an interior point iteration: Q + H with the border c for the bias.

use nalgebra::Vector4;

use crate::cholesky::Panels;
use crate::cone::Scaling;
use crate::gram::{begins, gram};
use crate::lanes::Lane;
use crate::problem::Problem;

/// By what share the diagonal is raised until the factor exists: near the boundary of a cone the entries
/// of H cancel to its small eigenvalues, and rounding makes the matrix indefinite. The step is then
/// less exact, and the next one starts from what it has left.
const RAISES: [f64; 5] = [0.0, 1e-15, 1e-14, 1e-13, 1e-12];

/// The matrices, and memory for their factor.
pub(crate) struct Newton {
    /// Where the variables of each point begin, and where those of the last end.
    begins: Vec<usize>,
    quadratic: Panels,
    factor: Panels,
    /// c of each multiplier.
    labels: Vec<f64>,
    /// The solution for the labels on the right.
    toward_bias: Vec<f64>,
    /// Their product.
    border: f64,
    column: Vec<f64>,
    moved: Vec<f64>,
    memory: Vec<Lane>,
}

impl Newton {
    /// `None` when the problem is too large.
    pub(crate) fn of(problem: &Problem) -> Option<Self> {
        let begins = begins(problem);
        let quadratic = gram(problem, &begins)?;
        let size = quadratic.size();
        let mut labels = vec![0.0; size];
        for (point, begin) in problem.points.iter().zip(&begins) {
            labels[*begin] = point.sign;
        }
        Some(Self {
            begins,
            quadratic,
            factor: Panels::default(),
            toward_bias: vec![0.0; size],
            labels,
            border: 0.0,
            column: vec![0.0; size],
            moved: vec![0.0; size],
            memory: Vec::new(),
        })
    }

    /// Q z, point by point.
    pub(crate) fn product(&mut self, z: &[Vector4<f64>], moved: &mut [Vector4<f64>]) {
        gather(&self.begins, |i| z[i], &mut self.column);
        self.quadratic.product(&self.column, &mut self.moved, &mut self.memory);
        scatter(&self.begins, &self.moved, moved);
    }

    /// Factors Q + H, with ξ/u of each point's bound; `None` when rounding has made it indefinite, and
    /// more than rounding on its diagonal does not mend that.
    pub(crate) fn factor(
        &mut self,
        scalings: &[Scaling],
        bound: impl Fn(usize) -> f64,
    ) -> Option<()> {
        let positive = RAISES.into_iter().any(|raise| {
            self.fill(scalings, &bound, 1.0 + raise);
            self.factor.factor().is_some()
        });
        if !positive {
            return None;
        }
        self.toward_bias.copy_from_slice(&self.labels);
        self.factor.solve(&mut self.toward_bias, &mut self.memory);
        self.border = dot(&self.labels, &self.toward_bias);
        Some(())
    }

    /// Q + H, its diagonal times a factor.
    fn fill(&mut self, scalings: &[Scaling], bound: impl Fn(usize) -> f64, raise: f64) {
        self.factor.copy_from(&self.quadratic);
        for (i, scaling) in scalings.iter().enumerate() {
            let (begin, end) = (self.begins[i], self.begins[i + 1]);
            let mut h = scaling.squared();
            h[(0, 0)] += bound(i);
            for column in begin..end {
                for row in column..end {
                    *self.factor.entry(row, column) += h[(row - begin, column - begin)];
                }
                *self.factor.entry(column, column) *= raise;
            }
        }
    }

    /// The step of the multipliers, and that of the bias, that the right side asks for.
    pub(crate) fn solve(
        &mut self,
        right: impl Fn(usize) -> Vector4<f64>,
    ) -> (Vec<Vector4<f64>>, f64) {
        gather(&self.begins, right, &mut self.column);
        self.factor.solve(&mut self.column, &mut self.memory);
        let bias = dot(&self.labels, &self.column) / self.border;
        for (value, toward_bias) in self.column.iter_mut().zip(&self.toward_bias) {
            *value -= toward_bias * bias;
        }
        let mut z = vec![Vector4::zeros(); self.begins.len() - 1];
        scatter(&self.begins, &self.column, &mut z);
        (z, bias)
    }
}

/// Takes from the blocks what their points have variables for.
fn gather(begins: &[usize], block: impl Fn(usize) -> Vector4<f64>, column: &mut [f64]) {
    for i in 0..begins.len() - 1 {
        let values = &mut column[begins[i]..begins[i + 1]];
        values.copy_from_slice(&block(i).as_slice()[..values.len()]);
    }
}

fn scatter(begins: &[usize], column: &[f64], blocks: &mut [Vector4<f64>]) {
    for (i, block) in blocks.iter_mut().enumerate() {
        *block = Vector4::zeros();
        let values = &column[begins[i]..begins[i + 1]];
        block.as_mut_slice()[..values.len()].copy_from_slice(values);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
