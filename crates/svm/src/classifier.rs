//! The decision function (eq. 14) and the probability of being on its wrong side (eq. 16).

use cloudtouch_geom::{Point3, UncertainPoint, Vector3, normal};

use crate::{Class, Kernel, Problem, Solution, Status, UnitBox};

/// A trained decision function f: positive on the side of class A, negative on that of B.
#[derive(Debug, Clone)]
pub struct Classifier {
    expansion: Expansion,
    bias: f64,
    /// Origin of the coordinates of the expansion.
    centre: Point3,
    /// Maps points handed in into the frame the problem was posed in.
    frame: UnitBox,
}

#[derive(Debug, Clone)]
enum Expansion {
    Plane { normal: Vector3 },
    Gaussian { gamma: f64, terms: Vec<Term> },
}

#[derive(Debug, Clone)]
struct Term {
    x: Vector3,
    /// cα.
    a: f64,
    /// S v.
    s: Vector3,
}

/// Why a solution gives no classifier.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ClassifierError {
    /// The solution belongs to another problem.
    #[error(
        "the solution has {solution} multipliers for {problem} samples: pass the problem it solves"
    )]
    SizeMismatch {
        /// Multipliers in the solution.
        solution: usize,
        /// Samples in the problem.
        problem: usize,
    },
    /// The solve ended in a way that leaves probabilities undetermined.
    #[error(
        "the solve ended as {status:?} with a relative gap of {relative_gap:.1e}, which determines no \
         probability: report the pair as undecided, or solve further"
    )]
    Undetermined {
        /// How the solve ended.
        status: Status,
        /// How far it got.
        relative_gap: f64,
    },
}

impl Classifier {
    /// Builds the decision function of a solved problem, keeping only its support vectors.
    ///
    /// # Errors
    /// When the solution does not belong to the problem, or when it does not
    /// [determine probabilities](Solution::determines_probabilities), as after a collapse.
    pub fn try_new(problem: &Problem, solution: &Solution) -> Result<Self, ClassifierError> {
        if solution.alpha.len() != problem.len() || solution.v.len() != problem.len() {
            return Err(ClassifierError::SizeMismatch {
                solution: solution.alpha.len(),
                problem: problem.len(),
            });
        }
        if !solution.determines_probabilities() {
            return Err(ClassifierError::Undetermined {
                status: solution.status,
                relative_gap: solution.relative_gap,
            });
        }
        let terms: Vec<Term> = problem
            .points
            .iter()
            .zip(solution.alpha.iter().zip(&solution.v))
            .filter(|(_, (alpha, _))| **alpha > 0.0)
            .map(|(point, (alpha, v))| {
                // v = r E p, so S v = Tᵀp = E diag(√λ) Eᵀ v.
                let s = if point.is_uncertain() {
                    point.displacement(&(point.axes.tr_mul(v) / point.radius))
                } else {
                    Vector3::zeros()
                };
                Term { x: point.x, a: point.sign * alpha, s }
            })
            .collect();
        let expansion = match problem.kernel {
            Kernel::Linear => {
                Expansion::Plane { normal: terms.iter().map(|t| t.x * t.a + t.s).sum() }
            }
            Kernel::Gaussian { gamma } => Expansion::Gaussian { gamma, terms },
        };
        Ok(Self {
            expansion,
            bias: solution.bias,
            centre: problem.centre,
            frame: UnitBox::identity(),
        })
    }

    /// The same decision function for points in the frame that `unit_box` scales from.
    ///
    /// For a problem posed on samples mapped by `unit_box`: values keep, gradients become per metre.
    #[must_use]
    pub fn outside(self, unit_box: UnitBox) -> Self {
        Self { frame: unit_box, ..self }
    }

    /// How many support vectors the function has; 1 for a plane.
    pub fn term_count(&self) -> usize {
        match &self.expansion {
            Expansion::Plane { .. } => 1,
            Expansion::Gaussian { terms, .. } => terms.len(),
        }
    }

    /// f at a point (eq. 14).
    pub fn value(&self, point: &Point3) -> f64 {
        self.value_and_gradient(point).0
    }

    /// f and ∇f at a point; the gradient is per unit of length of the point's frame.
    pub fn value_and_gradient(&self, point: &Point3) -> (f64, Vector3) {
        let x = self.frame.point_inside(point) - self.centre;
        let (value, gradient) = match &self.expansion {
            Expansion::Plane { normal } => (normal.dot(&x), *normal),
            Expansion::Gaussian { gamma, terms } => {
                let kernel = Kernel::Gaussian { gamma: *gamma };
                terms.iter().fold((0.0, Vector3::zeros()), |(value, gradient), term| {
                    let k = kernel.value(&term.x, &x);
                    let (df, dg) = kernel.influence(&term.x, &x, k, term.a, &term.s);
                    (value + df, gradient + dg)
                })
            }
        };
        (value + self.bias, gradient * self.frame.scale())
    }

    /// Probability that the true point lies on the other class's side of the surface:
    /// P = Φ(−c f(m)/|S ∇f(m)|) (eq. 16).
    ///
    /// The tail keeps its relative accuracy: P is 0 only below the range of `f64`. Where |S ∇f| = 0
    /// (an exact point, or a flat f) P is the step function: 1 on the wrong side, ½ on f = 0, else
    /// 0. First-order: it takes f as linear over the ellipsoid.
    ///
    /// `None` when the result is not a number, as for a point that is not finite; it must never be
    /// read as "free".
    pub fn probability(&self, point: &UncertainPoint, class: Class) -> Option<f64> {
        let (value, gradient) = self.value_and_gradient(&point.mean);
        let std =
            if point.covariance.is_zero() { 0.0 } else { point.covariance.std_along(&gradient) };
        // `std_along` clamps at zero, which would turn a NaN covariance into an exact point.
        let finite = value.is_finite()
            && gradient.iter().all(|v| v.is_finite())
            && std.is_finite()
            && point.covariance.is_finite();
        if !finite {
            return None;
        }
        let probability = normal::below_zero(class.sign() * value, std);
        (!probability.is_nan()).then_some(probability)
    }
}
