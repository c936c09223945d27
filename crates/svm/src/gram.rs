//! The dense quadratic form of the dual, for the interior point methods.

use cloudtouch_geom::Vector3;
use faer::Mat;

use crate::kernel::Kernel;
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

/// The Gram matrix B of the dual's quadratic form (full, symmetric), of feature vectors relative to
/// that of the centre: with Σcα = 0 that is the same form, and it keeps its digits where the kernel is
/// wide. `None` when it is too large.
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
                felt = centred_influence(&problem.kernel, from, to, *a, s);
                last = Some(target);
            }
            let value = terms[row].0 * felt.0 + terms[row].1.dot(&felt.1);
            matrix[(row, column)] = value;
            matrix[(column, row)] = value;
        }
    }
    Some(matrix)
}

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

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Point3, UncertainPoint};

    use super::*;
    use crate::sample::{Class, Sample};

    #[test]
    fn the_matrix_is_symmetric_and_positive_where_the_kernel_is_wide() {
        let sample = |k: u32| Sample {
            point: UncertainPoint {
                mean: Point3::new(f64::from(k), f64::from(k * k), 0.3 * f64::from(k % 3)),
                covariance: Covariance::diagonal([0.1, 0.2, 0.3]),
            },
            class: if k % 2 == 0 { Class::A } else { Class::B },
            radius: 1.0,
            penalty: 1.0,
        };
        let samples: Vec<Sample> = (0..5).map(sample).collect();
        for gamma in [1e-18, 1e-9, 1.0] {
            let problem = Problem::try_new(&samples, Kernel::Gaussian { gamma }).unwrap();
            let variables = variables(&problem);
            let matrix = gram(&problem, &variables).unwrap();
            let size = (0..variables.len()).map(|i| matrix[(i, i)]).fold(0.0, f64::max);
            for x in 0..20_u32 {
                let z: Vec<f64> =
                    (0..variables.len()).map(|i| f64::from((x + 1) * i as u32 % 7) - 3.0).collect();
                let value: f64 = (0..z.len())
                    .map(|i| (0..z.len()).map(|j| z[i] * matrix[(i, j)] * z[j]).sum::<f64>())
                    .sum();
                assert!(value >= -1e-12 * size, "gamma {gamma}: {value} of {size}");
            }
        }
    }
}
