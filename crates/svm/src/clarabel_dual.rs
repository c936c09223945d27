//! Rung 3: the dual (eq. 13) as a second-order cone program for Clarabel.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT,
    SolverStatus, SupportedConeT, ZeroConeT,
};
use cloudtouch_geom::Vector3;
use faer::MatRef;

use crate::interior::gram::{begins, gram};
use crate::problem::Problem;
use crate::status::Status;

/// One scalar variable of the dual: a multiplier, or a component of a cone vector.
#[derive(Debug, Clone, Copy)]
struct Variable {
    point: usize,
    /// `None` for α, the eigen-axis for a component of p.
    axis: Option<usize>,
}

/// The variables of the dual; axes without variance have none.
fn variables(problem: &Problem) -> Vec<Variable> {
    let mut all = Vec::new();
    for (index, point) in problem.points.iter().enumerate() {
        all.push(Variable { point: index, axis: None });
        let axes = (0..3).filter(|&axis| point.t[axis] > 0.0);
        all.extend(axes.map(|axis| Variable { point: index, axis: Some(axis) }));
    }
    all
}

/// What Clarabel found: α and p in sample order, and its iterations. Not necessarily feasible to
/// the last digit, and not necessarily optimal: the caller certifies it.
pub(crate) struct ClarabelDual {
    pub(crate) alpha: Vec<f64>,
    pub(crate) p: Vec<Vector3>,
    pub(crate) iterations: usize,
    /// How it ended, by its own account.
    pub(crate) status: Status,
}

/// Solves the dual with Clarabel.
///
/// # Errors
/// [`Status::TooLarge`] where the dense matrix is not built, [`Status::Refused`] where Clarabel does
/// not take the numbers.
pub(crate) fn solve(
    problem: &Problem,
    relative_gap: f64,
    max_iterations: usize,
) -> Result<ClarabelDual, Status> {
    let variables = variables(problem);
    let quadratic =
        upper_triangle(gram(problem, &begins(problem)).ok_or(Status::TooLarge)?.as_ref());
    let linear: Vec<f64> =
        variables.iter().map(|v| if v.axis.is_none() { -1.0 } else { 0.0 }).collect();
    let (constraints, bounds, cones) = constraints(problem, &variables);
    let tolerance = (relative_gap * 0.1).clamp(1e-12, 1e-4);
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .max_iter(u32::try_from(max_iterations).unwrap_or(u32::MAX))
        .max_threads(1)
        .tol_gap_abs(tolerance)
        .tol_gap_rel(tolerance)
        .tol_feas(tolerance)
        .build()
        .map_err(|_| Status::Refused)?;
    let mut solver =
        DefaultSolver::new(&quadratic, &linear, &constraints, &bounds, &cones, settings)
            .map_err(|_| Status::Refused)?;
    solver.solve();
    let mut alpha = vec![0.0; problem.len()];
    let mut p = vec![Vector3::zeros(); problem.len()];
    for (variable, &value) in variables.iter().zip(&solver.solution.x) {
        match variable.axis {
            None => alpha[variable.point] = value,
            Some(axis) => p[variable.point][axis] = value,
        }
    }
    let status = match solver.solution.status {
        SolverStatus::Solved => Status::Converged,
        SolverStatus::MaxIterations => Status::IterationLimit,
        _ => Status::Stalled,
    };
    Ok(ClarabelDual { alpha, p, iterations: solver.solution.iterations as usize, status })
}

fn upper_triangle(matrix: MatRef<'_, f64>) -> CscMatrix<f64> {
    let n = matrix.ncols();
    let mut starts = vec![0];
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    for column in 0..n {
        for row in 0..=column {
            rows.push(row);
            values.push(matrix[(row, column)]);
        }
        starts.push(rows.len());
    }
    CscMatrix::new(n, n, starts, rows, values)
}

/// A x + s = b with s in the cones: Σcα = 0, then α ≤ C, then α ≥ 0 for exact points, then the
/// cone (α, p) of each uncertain point.
fn constraints(
    problem: &Problem,
    variables: &[Variable],
) -> (CscMatrix<f64>, Vec<f64>, Vec<SupportedConeT<f64>>) {
    let n = problem.len();
    let mut triplets: Vec<Vec<(usize, f64)>> = Vec::with_capacity(variables.len());
    let mut bounds = vec![0.0];
    bounds.extend(problem.points.iter().map(|p| p.penalty));
    let exact: Vec<usize> = (0..n).filter(|&i| !problem.points[i].is_uncertain()).collect();
    let mut cones = vec![ZeroConeT(1), NonnegativeConeT(n)];
    if !exact.is_empty() {
        cones.push(NonnegativeConeT(exact.len()));
    }
    let mut next_cone_row = 1 + n + exact.len();
    let mut exact_row = 1 + n;
    let mut cone_size = 0;
    for variable in variables {
        let point = &problem.points[variable.point];
        match variable.axis {
            None => {
                let mut column = vec![(0, point.sign), (1 + variable.point, 1.0)];
                if point.is_uncertain() {
                    if cone_size > 0 {
                        cones.push(SecondOrderConeT(cone_size));
                    }
                    column.push((next_cone_row, -1.0));
                    next_cone_row += 1;
                    cone_size = 1;
                } else {
                    column.push((exact_row, -1.0));
                    exact_row += 1;
                }
                triplets.push(column);
            }
            Some(_) => {
                triplets.push(vec![(next_cone_row, -1.0)]);
                next_cone_row += 1;
                cone_size += 1;
            }
        }
    }
    if cone_size > 0 {
        cones.push(SecondOrderConeT(cone_size));
    }
    bounds.resize(next_cone_row, 0.0);
    let mut starts = vec![0];
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    for column in triplets {
        for (row, value) in column {
            rows.push(row);
            values.push(value);
        }
        starts.push(rows.len());
    }
    (CscMatrix::new(next_cone_row, variables.len(), starts, rows, values), bounds, cones)
}
