//! The dense quadratic form of the dual, for the interior point methods.

use cloudtouch_geom::Vector3;
use nalgebra::Matrix4;

use crate::interior::square::Square;
use crate::lanes::Lanes;
use crate::problem::kernel::Kernel;
use crate::problem::{PreparedPoint, Problem};

/// Dual variables beyond which the dense matrix is not built (46 MB, and seconds an iteration).
const MAX_VARIABLES: usize = 2400;

/// Where the variables of each point begin, and where those of the last end: its multiplier, then a
/// component of its cone vector for each axis; axes without variance come last and have none.
pub(crate) fn begins(problem: &Problem) -> Vec<usize> {
    let mut begins = vec![0];
    let mut end = 0;
    for point in &problem.points {
        end += 1 + point.t.iter().filter(|t| **t > 0.0).count();
        begins.push(end);
    }
    begins
}

/// The Gram matrix B of the dual's quadratic form (full, symmetric), of feature vectors relative to
/// that of the centre: with Σcα = 0 that is the same form, and it keeps its digits where the kernel is
/// wide. `None` when it is too large.
pub(crate) fn gram(problem: &Problem, begins: &[usize]) -> Option<Square> {
    let size = begins[problem.len()];
    if size > MAX_VARIABLES {
        return None;
    }
    let zero = Vector3::zeros();
    let mut row = Lanes::default();
    row.reset(problem.len());
    problem.kernel.reduced_row(&zero, &problem.places, row.lanes_mut());
    let features: Vec<Features<'_>> = problem
        .points
        .iter()
        .enumerate()
        .map(|(i, point)| {
            let at_zero = turned_difference(&problem.kernel, row.at(i), &point.x);
            Features { point, reduced_at_zero: row.at(i), at_zero: point.factor * at_zero }
        })
        .collect();
    let mut matrix = Square::zeros(size);
    for (j, of_j) in features.iter().enumerate() {
        problem.kernel.reduced_row(&of_j.point.x, &problem.places, row.lanes_mut());
        for (i, of_i) in features[..=j].iter().enumerate() {
            let block = of_i.products(of_j, &problem.kernel, row.at(i));
            let [rows, columns] = [i, j].map(|k| begins[k]..begins[k + 1]);
            for (b, column) in columns.clone().enumerate() {
                let to = &mut matrix.column_mut(column)[rows.clone()];
                to.iter_mut().zip(&block.column(b)).for_each(|(to, value)| *to = *value);
            }
            // Of a point with itself the block is symmetric but for rounding.
            for (a, column) in rows.enumerate().filter(|_| i < j) {
                let to = &mut matrix.column_mut(column)[columns.clone()];
                to.iter_mut().zip(&block.row(a)).for_each(|(to, value)| *to = *value);
            }
        }
    }
    Some(matrix)
}

/// The feature vectors of a point's variables: c(φ(x) − φ(0)), and φ'(x) along each axis.
struct Features<'a> {
    point: &'a PreparedPoint,
    reduced_at_zero: f64,
    /// What φ(0) gives with each axis.
    at_zero: Vector3,
}

impl Features<'_> {
    /// The inner products with the features of another point, `reduced` being the kernel of the two.
    fn products(&self, other: &Self, kernel: &Kernel, reduced: f64) -> Matrix4<f64> {
        let (i, j) = (self.point, other.point);
        let d = j.x - i.x;
        let (of_i, of_j) = match kernel {
            Kernel::Linear => (i.factor * j.x, j.factor * i.x),
            Kernel::Gaussian { .. } => {
                let slope = turned_difference(kernel, reduced, &d);
                (-(i.factor * slope) - self.at_zero, j.factor * slope - other.at_zero)
            }
        };
        let mut block = Matrix4::zeros();
        block[(0, 0)] = i.sign * j.sign * (reduced - self.reduced_at_zero - other.reduced_at_zero);
        block.fixed_view_mut::<1, 3>(0, 1).copy_from(&(of_j * i.sign).transpose());
        block.fixed_view_mut::<3, 1>(1, 0).copy_from(&(of_i * j.sign));
        let axes = i.factor * j.factor.transpose();
        let axes = match *kernel {
            Kernel::Linear => axes,
            Kernel::Gaussian { gamma } => {
                let across = (i.factor * d) * (j.factor * d).transpose();
                (axes - across * (2.0 * gamma)) * (2.0 * gamma * (1.0 + reduced))
            }
        };
        block.fixed_view_mut::<3, 3>(1, 1).copy_from(&axes);
        block
    }
}

/// −2γk d, whose product with a displacement at the far end of `d` is that of the two features; for
/// the linear kernel, of the feature at 0, nothing.
fn turned_difference(kernel: &Kernel, reduced: f64, d: &Vector3) -> Vector3 {
    match *kernel {
        Kernel::Linear => Vector3::zeros(),
        Kernel::Gaussian { gamma } => d * (-2.0 * gamma * (1.0 + reduced)),
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Point3, UncertainPoint};

    use super::*;
    use crate::problem::sample::{Class, Sample};

    /// What a term adds at `to`, of feature vectors relative to φ(0).
    fn centred_influence(
        kernel: &Kernel,
        from: &Vector3,
        to: &Vector3,
        a: f64,
        s: &Vector3,
    ) -> (f64, Vector3) {
        let (zero, still) = (Vector3::zeros(), Vector3::zeros());
        let (value, gradient) = kernel.influence(from, to, kernel.reduced(from, to), a, s);
        let (at_zero, _) = kernel.influence(from, &zero, kernel.reduced(from, &zero), a, s);
        let (of_zero, slope) = kernel.influence(&zero, to, kernel.reduced(&zero, to), a, &still);
        (value - at_zero - of_zero, gradient - slope)
    }

    #[test]
    fn the_matrix_is_what_the_kernel_says_term_by_term() {
        let sample = |k: u32| Sample {
            point: UncertainPoint {
                mean: Point3::new(f64::from(k), f64::from(k * k), 0.3 * f64::from(k % 3)) * 0.2,
                covariance: if k == 2 {
                    Covariance::zero()
                } else {
                    Covariance::diagonal([0.1, 0.2, if k == 3 { 0.0 } else { 0.3 }])
                },
            },
            class: if k.is_multiple_of(2) { Class::A } else { Class::B },
            radius: 1.5,
            penalty: 1.0,
        };
        let samples: Vec<Sample> = (0..5).map(sample).collect();
        for kernel in [Kernel::Linear, Kernel::Gaussian { gamma: 0.3 }] {
            let problem = Problem::new(&samples, kernel).unwrap();
            let begins = begins(&problem);
            assert_eq!(begins, [0, 4, 8, 9, 12, 16]);
            let matrix = gram(&problem, &begins).unwrap();
            let matrix = matrix.as_ref();
            let term = |k: usize| {
                let i = begins.partition_point(|begin| *begin <= k) - 1;
                let point = &problem.points[i];
                match k - begins[i] {
                    0 => (point.x, point.sign, Vector3::zeros()),
                    axis => (point.x, 0.0, point.factor.row(axis - 1).transpose()),
                }
            };
            for (row, to) in (0..16).map(term).enumerate() {
                for (column, from) in (0..16).map(term).enumerate() {
                    let (f, g) = centred_influence(&kernel, &from.0, &to.0, from.1, &from.2);
                    let expected = to.1 * f + to.2.dot(&g);
                    assert!((matrix[(row, column)] - expected).abs() < 1e-14, "{row}, {column}");
                }
            }
        }
    }

    #[test]
    fn the_matrix_is_symmetric_and_positive_where_the_kernel_is_wide() {
        let sample = |k: u32| Sample {
            point: UncertainPoint {
                mean: Point3::new(f64::from(k), f64::from(k * k), 0.3 * f64::from(k % 3)),
                covariance: Covariance::diagonal([0.1, 0.2, 0.3]),
            },
            class: if k.is_multiple_of(2) { Class::A } else { Class::B },
            radius: 1.0,
            penalty: 1.0,
        };
        let samples: Vec<Sample> = (0..5).map(sample).collect();
        for gamma in [1e-18, 1e-9, 1.0] {
            let problem = Problem::new(&samples, Kernel::Gaussian { gamma }).unwrap();
            let begins = begins(&problem);
            let matrix = gram(&problem, &begins).unwrap();
            let matrix = matrix.as_ref();
            let count = matrix.ncols();
            let size = (0..count).map(|i| matrix[(i, i)]).fold(0.0, f64::max);
            for x in 0..20_u32 {
                let z: Vec<f64> =
                    (0..count).map(|i| f64::from((x + 1) * i as u32 % 7) - 3.0).collect();
                let value: f64 = (0..z.len())
                    .map(|i| (0..z.len()).map(|j| z[i] * matrix[(i, j)] * z[j]).sum::<f64>())
                    .sum();
                assert!(value >= -1e-12 * size, "gamma {gamma}: {value} of {size}");
            }
        }
    }
}
