//! The linear system of an interior point iteration: Q + H with the border c for the bias.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::{factor, solve};
use faer::{Mat, Par};
use nalgebra::Vector4;

use crate::cone::Scaling;
use crate::gram::{self, gram, variables};
use crate::problem::Problem;

/// The matrices, and memory for their factor.
pub(crate) struct Newton {
    /// Where the variables of each point begin, and where those of the last end.
    begins: Vec<usize>,
    quadratic: Mat<f64>,
    factor: Mat<f64>,
    memory: MemBuffer,
    /// c of each multiplier.
    labels: Mat<f64>,
    /// The solution for the labels on the right.
    toward_bias: Mat<f64>,
    /// Their product.
    border: f64,
    column: Mat<f64>,
    flat: Vec<f64>,
}

impl Newton {
    /// `None` when the problem is too large.
    pub(crate) fn of(problem: &Problem) -> Option<Self> {
        let variables = variables(problem);
        let size = variables.len();
        let quadratic = gram(problem, &variables)?;
        let firsts = variables.iter().enumerate().filter(|(_, v)| v.axis.is_none());
        let begins: Vec<usize> = firsts.map(|(k, _)| k).chain([size]).collect();
        let mut labels = Mat::zeros(size, 1);
        for (point, begin) in problem.points.iter().zip(&begins) {
            labels[(*begin, 0)] = point.sign;
        }
        let scratch =
            factor::cholesky_in_place_scratch::<f64>(size, Par::Seq, Default::default());
        Some(Self {
            begins,
            factor: Mat::zeros(size, size),
            quadratic,
            memory: MemBuffer::new(scratch),
            toward_bias: Mat::zeros(size, 1),
            labels,
            border: 0.0,
            column: Mat::zeros(size, 1),
            flat: vec![0.0; size],
        })
    }

    /// Q z, point by point.
    pub(crate) fn product(&mut self, z: &[Vector4<f64>], moved: &mut [Vector4<f64>]) {
        let Self { begins, quadratic, flat, column, .. } = self;
        for (i, z) in z.iter().enumerate() {
            let range = begins[i]..begins[i + 1];
            let count = range.len();
            flat[range].copy_from_slice(&z.as_slice()[..count]);
        }
        let product = column.col_as_slice_mut(0);
        gram::product(quadratic, flat, product);
        scatter(begins, product, moved);
    }

    /// Factors Q + H, with ξ/u of each point's bound; `None` when rounding has made it indefinite.
    pub(crate) fn factor(
        &mut self,
        scalings: &[Scaling],
        bound: impl Fn(usize) -> f64,
    ) -> Option<()> {
        let size = self.flat.len();
        // The lower triangle is all that the factor is made of.
        for column in 0..size {
            let from = &self.quadratic.col_as_slice(column)[column..];
            self.factor.col_as_slice_mut(column)[column..].copy_from_slice(from);
        }
        for (i, scaling) in scalings.iter().enumerate() {
            let (begin, end) = (self.begins[i], self.begins[i + 1]);
            let mut h = scaling.squared();
            h[(0, 0)] += bound(i);
            for column in begin..end {
                let lower = &mut self.factor.col_as_slice_mut(column)[column..end];
                for (k, value) in lower.iter_mut().enumerate() {
                    *value += h[(column - begin + k, column - begin)];
                }
            }
        }
        factor::cholesky_in_place(
            self.factor.as_mut(),
            Default::default(),
            Par::Seq,
            MemStack::new(&mut self.memory),
            Default::default(),
        )
        .ok()?;
        self.toward_bias.copy_from(&self.labels);
        let stack = MemStack::new(&mut self.memory);
        solve::solve_in_place(self.factor.as_ref(), self.toward_bias.as_mut(), Par::Seq, stack);
        self.border = dot(&self.labels, &self.toward_bias);
        Some(())
    }

    /// The step of the multipliers, and that of the bias, that the right side asks for.
    pub(crate) fn solve(
        &mut self,
        right: impl Fn(usize) -> Vector4<f64>,
    ) -> (Vec<Vector4<f64>>, f64) {
        let points = self.begins.len() - 1;
        let column = self.column.col_as_slice_mut(0);
        for i in 0..points {
            let range = self.begins[i]..self.begins[i + 1];
            let count = range.len();
            column[range].copy_from_slice(&right(i).as_slice()[..count]);
        }
        let stack = MemStack::new(&mut self.memory);
        solve::solve_in_place(self.factor.as_ref(), self.column.as_mut(), Par::Seq, stack);
        let bias = dot(&self.labels, &self.column) / self.border;
        let toward_bias = self.toward_bias.col_as_slice(0);
        let solution = self.column.col_as_slice_mut(0);
        for (value, toward_bias) in solution.iter_mut().zip(toward_bias) {
            *value -= toward_bias * bias;
        }
        let mut z = vec![Vector4::zeros(); points];
        scatter(&self.begins, solution, &mut z);
        (z, bias)
    }
}

fn scatter(begins: &[usize], column: &[f64], blocks: &mut [Vector4<f64>]) {
    for (i, block) in blocks.iter_mut().enumerate() {
        *block = Vector4::zeros();
        let values = &column[begins[i]..begins[i + 1]];
        block.as_mut_slice()[..values.len()].copy_from_slice(values);
    }
}

fn dot(a: &Mat<f64>, b: &Mat<f64>) -> f64 {
    a.col_as_slice(0).iter().zip(b.col_as_slice(0)).map(|(a, b)| a * b).sum()
}
