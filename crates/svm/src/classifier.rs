//! The decision function (eq. 14) and the probability of being on its wrong side (eq. 16).

use cloudtouch_geom::{Point3, UncertainPoint, Vector3, normal};

use crate::bounds::{Range, Reference};
use crate::problem::Problem;
use crate::problem::kernel::Kernel;
use crate::problem::sample::Class;
use crate::problem::unit_box::UnitBox;
use crate::solution::{ErrorBounds, Solution, Undetermined};

/// A trained decision function f: positive on the side of class A, negative on that of B.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Classifier {
    expansion: Expansion,
    bias: f64,
    error: ErrorBounds,
    /// What the error of f is measured from.
    reference: Reference,
    /// Origin of the coordinates of the expansion.
    centre: Point3,
    /// Maps points handed in into the frame the problem was posed in.
    frame: UnitBox,
}

#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Expansion {
    Plane { normal: Vector3 },
    Gaussian { gamma: f64, terms: Vec<Term> },
}

#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
    /// The solution determines no probability.
    #[error("no probability is determined: report the pair as undecided")]
    Undetermined(#[from] Undetermined),
}

impl Classifier {
    /// Builds the decision function of a solved problem, keeping only its support vectors.
    ///
    /// # Errors
    /// When the solution does not belong to the problem, or when it does not
    /// [determine probabilities](Solution::determined), as after a collapse.
    pub fn new(problem: &Problem, solution: &Solution) -> Result<Self, ClassifierError> {
        if solution.alpha.len() != problem.len() || solution.displacement.len() != problem.len() {
            return Err(ClassifierError::SizeMismatch {
                solution: solution.alpha.len(),
                problem: problem.len(),
            });
        }
        solution.determined()?;
        let terms: Vec<Term> = problem
            .points
            .iter()
            .zip(solution.alpha.iter().zip(&solution.displacement))
            .filter(|(_, (alpha, _))| **alpha > 0.0)
            .map(|(point, (alpha, &s))| Term { x: point.x, a: point.sign * alpha, s })
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
            error: solution.error,
            reference: Reference::of(problem),
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

    /// b, of f₀ + b with f₀ taken relative to [`Self::centre`].
    pub fn bias(&self) -> f64 {
        self.bias
    }

    /// The point that positions are taken relative to, in the frame the problem was posed in.
    pub fn centre(&self) -> Point3 {
        self.centre
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
        let x = self.relative(point);
        let (value, gradient) = match &self.expansion {
            Expansion::Plane { normal } => (normal.dot(&x), *normal),
            Expansion::Gaussian { gamma, terms } => {
                let kernel = Kernel::Gaussian { gamma: *gamma };
                terms.iter().fold((0.0, Vector3::zeros()), |(value, gradient), term| {
                    let reduced = kernel.reduced(&term.x, &x);
                    let (df, dg) = kernel.influence(&term.x, &x, reduced, term.a, &term.s);
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
        let (value, deviation) = self.value_and_deviation(point)?;
        let probability = normal::below_zero(class.sign() * value, deviation);
        (!probability.is_nan()).then_some(probability)
    }

    /// f at a point for the optimal w and any optimal b: the least and the largest value that the
    /// duality gap of the solution allows.
    ///
    /// A guarantee ([`ErrorBounds`]); infinite or NaN for a point that is not finite.
    pub fn value_bounds(&self, point: &Point3) -> [f64; 2] {
        let base = self.value(point) - self.bias;
        let off = self.error.weight * self.reference.distance(&self.relative(point));
        [base + self.error.bias[0] - off, base + self.error.bias[1] + off]
    }

    /// The least and the largest value that [`Self::probability`] could have at the optimum.
    ///
    /// A guarantee on the optimisation, not on the model; `None` as [`Self::probability`].
    pub fn probability_bounds(&self, point: &UncertainPoint, class: Class) -> Option<[f64; 2]> {
        let (_, deviation) = self.value_and_deviation(point)?;
        let [low, high] = self.value_bounds(&point.mean);
        let value = if class == Class::A { [low, high] } else { [-high, -low] };
        let slope = self.reference.slope() * self.frame.scale();
        let off = self.error.weight * slope * point.covariance.max_std();
        let range = Range { value, deviation: [(deviation - off).max(0.0), deviation + off] };
        let bounds = range.probabilities();
        bounds.iter().all(|p| !p.is_nan()).then_some(bounds)
    }

    /// Position in the coordinates of the expansion.
    fn relative(&self, point: &Point3) -> Vector3 {
        self.frame.point_inside(point) - self.centre
    }

    /// f and |S∇f|; `None` when one of them is not finite.
    fn value_and_deviation(&self, point: &UncertainPoint) -> Option<(f64, f64)> {
        let (value, gradient) = self.value_and_gradient(&point.mean);
        let deviation = point.covariance.std_along(&gradient);
        // `std_along` clamps at zero, which would turn a NaN covariance into an exact point.
        let finite = value.is_finite()
            && gradient.iter().all(|v| v.is_finite())
            && deviation.is_finite()
            && point.covariance.is_finite();
        finite.then_some((value, deviation))
    }
}
