//! A surface that separates the points of a leaf pair: positive on the side of A.

use cloudtouch_geom::{Point3, UncertainPoint, Vector3, normal};
use cloudtouch_svm::{Class, Classifier, Separation};

/// A projection ends within this share of its reach of f = 0.
pub(crate) const SETTLED: f64 = 1e-3;

/// A separating surface in the local frame of A, metres.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Surface {
    /// A plane.
    Plane(Separation),
    /// f(x) = 0 of a kernel classifier.
    Kernel(Classifier),
}

impl Surface {
    /// Value and gradient (per metre) at a point; the value is positive on the side of A.
    pub(crate) fn value_and_gradient(&self, point: &Point3) -> (f64, Vector3) {
        match self {
            Self::Plane(plane) => (plane.signed_distance(point), -plane.normal),
            Self::Kernel(classifier) => classifier.value_and_gradient(point),
        }
    }

    /// Probability that a point lies on the wrong side (eq. 16); `None` when it is not a number.
    pub(crate) fn probability(&self, point: &UncertainPoint, class: Class) -> Option<f64> {
        match self {
            Self::Plane(plane) => {
                let inside = class.sign() * plane.signed_distance(&point.mean);
                let std = point.covariance.std_along(&plane.normal);
                let probability = normal::below_zero(inside, std);
                probability.is_finite().then_some(probability)
            }
            Self::Kernel(classifier) => classifier.probability(point, class),
        }
    }

    /// Moves a point onto the surface along the gradient; `None` when that does not succeed within
    /// `reach` metres (a flat spot of f, or f = 0 is far away).
    ///
    /// A step that does not bring f as near to 0 as half of what the gradient promises is halved:
    /// a whole one over a bend of f may end anywhere, and where hangs on the last digits of f.
    pub(crate) fn project(&self, point: &Point3, reach: f64) -> Option<(Point3, Vector3)> {
        /// Newton steps: one does for a plane, curved surfaces need a few more.
        const STEPS: usize = 16;
        /// The least share of a step.
        const SHORTEST: f64 = 1.0 / 16.0;
        let mut foot = *point;
        let (mut value, mut gradient) = self.value_and_gradient(&foot);
        for _ in 0..STEPS {
            let slope = gradient.norm();
            let distance = value / slope;
            if !distance.is_finite() {
                return None;
            }
            if distance.abs() <= SETTLED * reach {
                return Some((foot, -gradient / slope));
            }
            let step = gradient * (distance / slope);
            let mut share = 1.0;
            loop {
                let next = foot - step * share;
                let there = self.value_and_gradient(&next);
                if there.0.abs() <= (1.0 - 0.5 * share) * value.abs() {
                    (foot, value, gradient) = (next, there.0, there.1);
                    break;
                }
                share *= 0.5;
                if share < SHORTEST {
                    return None;
                }
            }
            if (foot - point).norm() > reach {
                return None;
            }
        }
        None
    }
}
