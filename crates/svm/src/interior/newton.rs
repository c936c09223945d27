//! The linear system of an interior point iteration: Q + H with the border c for the bias.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt;
use faer::linalg::cholesky::llt::factor::{LltParams, LltRegularization};
use faer::linalg::matmul::matmul;
use faer::{Accum, Col, Par, Scale, Spec};
use nalgebra::Vector4;

use crate::interior::cone::Scaling;
use crate::interior::gram::{begins, gram};
use crate::interior::square::Square;
use crate::problem::Problem;

/// By what share the diagonal is raised until the factor exists: near the boundary of a cone the entries
/// of H cancel to its small eigenvalues, and rounding makes the matrix indefinite. The step is then
/// less exact, and the next one starts from what it has left.
const RAISES: [f64; 5] = [0.0, 1e-15, 1e-14, 1e-13, 1e-12];

/// The matrices, and memory for their factor.
pub(crate) struct Newton {
    /// Where the variables of each point begin, and where those of the last end.
    begins: Vec<usize>,
    quadratic: Square,
    /// The Cholesky factor, below and on the diagonal.
    factor: Square,
    /// c of each multiplier.
    labels: Col<f64>,
    /// The solution for the labels on the right.
    toward_bias: Col<f64>,
    /// Their product.
    border: f64,
    column: Col<f64>,
    moved: Col<f64>,
    memory: MemBuffer,
}

impl Newton {
    /// `None` when the problem is too large.
    pub(crate) fn of(problem: &Problem) -> Option<Self> {
        let begins = begins(problem);
        let quadratic = gram(problem, &begins)?;
        let size = quadratic.size();
        let mut labels = Col::zeros(size);
        for (point, begin) in problem.points.iter().zip(&begins) {
            labels[*begin] = point.sign;
        }
        let memory = llt::factor::cholesky_in_place_scratch::<f64>(size, Par::Seq, parameters());
        Some(Self {
            begins,
            factor: Square::zeros(size),
            quadratic,
            toward_bias: Col::zeros(size),
            labels,
            border: 0.0,
            column: Col::zeros(size),
            moved: Col::zeros(size),
            memory: MemBuffer::new(memory),
        })
    }

    /// How many variables there are.
    pub(crate) fn variables(&self) -> usize {
        self.quadratic.size()
    }

    /// Q z, point by point.
    pub(crate) fn product(&mut self, z: &[Vector4<f64>], moved: &mut [Vector4<f64>]) {
        gather(&self.begins, |i| z[i], &mut self.column);
        let (to, from) = (self.moved.as_mat_mut(), self.column.as_mat());
        matmul(to, Accum::Replace, self.quadratic.as_ref(), from, 1.0, Par::Seq);
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
            let (matrix, memory) = (self.factor.as_mut(), MemStack::new(&mut self.memory));
            let none = LltRegularization::default();
            llt::factor::cholesky_in_place(matrix, none, Par::Seq, memory, parameters()).is_ok()
        });
        if !positive {
            return None;
        }
        self.toward_bias.copy_from(&self.labels);
        solve_in_place(&self.factor, &mut self.toward_bias);
        self.border = self.labels.transpose() * &self.toward_bias;
        Some(())
    }

    /// Q + H, its diagonal times a factor.
    fn fill(&mut self, scalings: &[Scaling], bound: impl Fn(usize) -> f64, raise: f64) {
        let mut factor = self.factor.as_mut();
        factor.copy_from_triangular_lower(self.quadratic.as_ref());
        for (i, scaling) in scalings.iter().enumerate() {
            let (begin, end) = (self.begins[i], self.begins[i + 1]);
            let mut h = scaling.squared();
            h[(0, 0)] += bound(i);
            for column in begin..end {
                for row in column..end {
                    factor[(row, column)] += h[(row - begin, column - begin)];
                }
                factor[(column, column)] *= raise;
            }
        }
    }

    /// The step of the multipliers, and that of the bias, that the right side asks for.
    pub(crate) fn solve(
        &mut self,
        right: impl Fn(usize) -> Vector4<f64>,
    ) -> (Vec<Vector4<f64>>, f64) {
        gather(&self.begins, right, &mut self.column);
        solve_in_place(&self.factor, &mut self.column);
        let bias = self.labels.transpose() * &self.column / self.border;
        self.column -= &self.toward_bias * Scale(bias);
        let mut z = vec![Vector4::zeros(); self.begins.len() - 1];
        scatter(&self.begins, &self.column, &mut z);
        (z, bias)
    }
}

fn parameters() -> Spec<LltParams, f64> {
    Spec::default()
}

fn solve_in_place(factor: &Square, right: &mut Col<f64>) {
    let none = MemStack::new(&mut []);
    llt::solve::solve_in_place(factor.as_ref(), right.as_mat_mut(), Par::Seq, none);
}

/// Takes from the blocks what their points have variables for.
fn gather(begins: &[usize], block: impl Fn(usize) -> Vector4<f64>, column: &mut Col<f64>) {
    for i in 0..begins.len() - 1 {
        let block = block(i);
        for k in begins[i]..begins[i + 1] {
            column[k] = block[k - begins[i]];
        }
    }
}

fn scatter(begins: &[usize], column: &Col<f64>, blocks: &mut [Vector4<f64>]) {
    for (i, block) in blocks.iter_mut().enumerate() {
        *block = Vector4::zeros();
        for k in begins[i]..begins[i + 1] {
            block[k - begins[i]] = column[k];
        }
    }
}
