//! The checked training problem, with the ellipsoid radius folded into each covariance factor.

pub(crate) mod kernel;
pub(crate) mod sample;
pub(crate) mod unit_box;

use cloudtouch_geom::message::number;
use cloudtouch_geom::{Matrix3, Point3, Vector3};

use crate::lanes::Lanes;
use crate::problem::kernel::Kernel;
use crate::problem::sample::{Class, Sample};

/// A robust classification problem (eq. 10) that has been checked and prepared.
#[derive(Debug, Clone)]
pub struct Problem {
    pub(crate) kernel: Kernel,
    /// Subtracted from every position, so that far-away origins cost no digits.
    pub(crate) centre: Point3,
    pub(crate) points: Vec<PreparedPoint>,
    /// x, y and z of the points.
    pub(crate) places: [Lanes; 3],
    /// T of the points, row by row.
    pub(crate) factors: [Lanes; 9],
    /// c and C of the points.
    pub(crate) signs: Lanes,
    pub(crate) penalties: Lanes,
    /// Whether any point has cone variables.
    pub(crate) has_uncertain: bool,
}

/// Why samples do not make a problem.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// There are no samples.
    #[error("there are no samples: a classifier needs at least one point of each class")]
    Empty,
    /// All samples are of one class.
    #[error("all {count} samples are of class {class:?}: add points of the other class")]
    OneClass {
        /// The class that is present.
        class: Class,
        /// How many samples there are.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("sample {index} lies at {point:?}: remove points that are not finite")]
    PositionNotFinite {
        /// Which sample.
        index: usize,
        /// Where it lies.
        point: [f64; 3],
    },
    /// A covariance, or its root times the radius, is NaN or infinite.
    #[error("sample {index} has an ellipsoid that is not finite: check its covariance and radius")]
    EllipsoidNotFinite {
        /// Which sample.
        index: usize,
    },
    /// A radius is negative or not finite.
    #[error("sample {index} has the radius {}: it must be finite and not negative", number(*value))]
    Radius {
        /// Which sample.
        index: usize,
        /// What was given.
        value: f64,
    },
    /// A penalty is not positive and finite.
    #[error("sample {index} has the penalty {}: it must be positive and finite", number(*value))]
    Penalty {
        /// Which sample.
        index: usize,
        /// What was given.
        value: f64,
    },
    /// γ is not positive and finite.
    #[error("the kernel width gamma is {}: it must be positive and finite", number(*value))]
    Gamma {
        /// What was given.
        value: f64,
    },
}

/// A sample as the solvers use it. With T = diag(t)·Eᵀ, a dual vector p (|p| ≤ α) displaces the
/// feature by D p = φ'(x)·Tᵀp, and Tᵀp = S v in the paper's terms.
#[derive(Debug, Clone)]
pub(crate) struct PreparedPoint {
    /// Position relative to the problem's centre.
    pub(crate) x: Vector3,
    pub(crate) sign: f64,
    pub(crate) penalty: f64,
    pub(crate) radius: f64,
    /// Eigenvectors E of the covariance, as columns.
    pub(crate) axes: Matrix3,
    /// √λ in descending order: what probabilities are read with, whatever the radius.
    pub(crate) std: Vector3,
    /// r√λ; an axis without variance has exactly 0.
    pub(crate) t: Vector3,
    /// T = diag(t)·Eᵀ.
    pub(crate) factor: Matrix3,
}

impl PreparedPoint {
    /// Whether the point has cone variables at all.
    #[inline]
    pub(crate) fn is_uncertain(&self) -> bool {
        self.t[0] > 0.0
    }

    /// Tᵀp: the displacement, in world axes, of the dual vector `p`.
    #[inline]
    pub(crate) fn displacement(&self, p: &Vector3) -> Vector3 {
        self.factor.tr_mul(p)
    }

    /// |S g|: the standard deviation along a gradient.
    pub(crate) fn deviation(&self, gradient: &Vector3) -> f64 {
        self.axes.tr_mul(gradient).component_mul(&self.std).norm()
    }

    /// Whether cα may rise and may fall from here.
    #[inline]
    pub(crate) fn may_move(&self, alpha: f64) -> [bool; 2] {
        let (up, down) = (alpha < self.penalty, alpha > 0.0);
        if self.sign > 0.0 { [up, down] } else { [down, up] }
    }
}

impl Problem {
    /// Checks the samples and prepares them: one 3×3 eigen-decomposition for each point whose
    /// covariance does not know its own axes.
    ///
    /// Points with radius 0 or covariance 0 get no cone variables. Positions are taken relative to
    /// the middle of their box. Order and mixture of classes are free.
    ///
    /// # Errors
    /// When there are no samples or only one class, when a coordinate, covariance, radius, penalty
    /// or γ is not finite, or when one of the latter three is out of its range.
    pub fn new(samples: &[Sample], kernel: Kernel) -> Result<Self, ProblemError> {
        if let Kernel::Gaussian { gamma } = kernel
            && !(gamma > 0.0 && gamma.is_finite())
        {
            return Err(ProblemError::Gamma { value: gamma });
        }
        let first = samples.first().ok_or(ProblemError::Empty)?;
        for (index, sample) in samples.iter().enumerate() {
            check(index, sample)?;
        }
        if samples.iter().all(|sample| sample.class == first.class) {
            return Err(ProblemError::OneClass { class: first.class, count: samples.len() });
        }
        let (low, high) = samples
            .iter()
            .map(|sample| sample.point.mean)
            .fold((first.point.mean, first.point.mean), |(l, h), p| (l.inf(&p), h.sup(&p)));
        // Halved before adding: the sum of two huge coordinates would overflow.
        let centre = Point3::from(low.coords * 0.5 + high.coords * 0.5);
        let points = samples
            .iter()
            .enumerate()
            .map(|(index, sample)| prepare(index, sample, &centre))
            .collect::<Result<Vec<PreparedPoint>, _>>()?;
        Ok(Self::of_points(kernel, centre, points))
    }

    fn of_points(kernel: Kernel, centre: Point3, points: Vec<PreparedPoint>) -> Self {
        let has_uncertain = points.iter().any(PreparedPoint::is_uncertain);
        let lanes = |of: &dyn Fn(&PreparedPoint) -> f64| Lanes::new(points.iter().map(of));
        Self {
            kernel,
            centre,
            places: std::array::from_fn(|axis| lanes(&|p| p.x[axis])),
            factors: std::array::from_fn(|k| lanes(&|p| p.factor[(k / 3, k % 3)])),
            signs: lanes(&|p| p.sign),
            penalties: lanes(&|p| p.penalty),
            points,
            has_uncertain,
        }
    }

    /// The problem of some of the samples alone, about the same centre.
    pub(crate) fn of_some(&self, samples: &[usize]) -> Self {
        let points = samples.iter().map(|&i| self.points[i].clone()).collect();
        Self::of_points(self.kernel, self.centre, points)
    }

    /// How many samples there are.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Always false: a problem has at least two samples.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The kernel.
    pub fn kernel(&self) -> Kernel {
        self.kernel
    }

    /// The middle of the box of the means: what positions, and with them
    /// [the bias](crate::Solution::bias), are relative to.
    pub fn centre(&self) -> Point3 {
        self.centre
    }
}

fn check(index: usize, sample: &Sample) -> Result<(), ProblemError> {
    let mean = &sample.point.mean;
    if !mean.iter().all(|v| v.is_finite()) {
        return Err(ProblemError::PositionNotFinite { index, point: [mean.x, mean.y, mean.z] });
    }
    if !sample.point.covariance.is_finite() {
        return Err(ProblemError::EllipsoidNotFinite { index });
    }
    if !(sample.radius >= 0.0 && sample.radius.is_finite()) {
        return Err(ProblemError::Radius { index, value: sample.radius });
    }
    if !(sample.penalty > 0.0 && sample.penalty.is_finite()) {
        return Err(ProblemError::Penalty { index, value: sample.penalty });
    }
    Ok(())
}

fn prepare(index: usize, sample: &Sample, centre: &Point3) -> Result<PreparedPoint, ProblemError> {
    let covariance = &sample.point.covariance;
    let (variances, axes) = covariance.eigen();
    let std = variances.map(f64::sqrt);
    let t = std * sample.radius;
    if !t.iter().chain(axes.iter()).all(|v| v.is_finite()) {
        return Err(ProblemError::EllipsoidNotFinite { index });
    }
    Ok(PreparedPoint {
        x: sample.point.mean - centre,
        sign: sample.class.sign(),
        penalty: sample.penalty,
        radius: sample.radius,
        axes,
        std,
        t,
        factor: Matrix3::from_diagonal(&t) * axes.transpose(),
    })
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, UncertainPoint};

    use super::*;

    fn sample(x: f64, class: Class) -> Sample {
        Sample {
            point: UncertainPoint {
                mean: Point3::new(x, 0.0, 0.0),
                covariance: Covariance::diagonal([1.0, 4.0, 0.0]),
            },
            class,
            radius: 2.0,
            penalty: 1.0,
        }
    }

    #[test]
    fn the_radius_is_folded_into_the_factor() {
        let problem =
            Problem::new(&[sample(0.0, Class::A), sample(1.0, Class::B)], Kernel::Linear).unwrap();
        let point = &problem.points[0];
        assert!((point.t - Vector3::new(4.0, 2.0, 0.0)).norm() < 1e-12);
        let squared = point.factor.transpose() * point.factor;
        let expected = Matrix3::from_diagonal(&Vector3::new(4.0, 16.0, 0.0));
        assert!((squared - expected).amax() < 1e-12);
    }

    #[test]
    fn bad_samples_are_refused_with_their_place() {
        let (a, b) = (sample(0.0, Class::A), sample(1.0, Class::B));
        let err = |samples: &[Sample]| Problem::new(samples, Kernel::Linear).unwrap_err();
        assert_eq!(err(&[]), ProblemError::Empty);
        assert_eq!(err(&[a, a]), ProblemError::OneClass { class: Class::A, count: 2 });
        let mut bad = b;
        bad.point.mean.y = f64::NAN;
        assert!(matches!(err(&[a, bad]), ProblemError::PositionNotFinite { index: 1, .. }));
        bad = Sample { radius: -1.0, ..b };
        assert_eq!(err(&[a, bad]), ProblemError::Radius { index: 1, value: -1.0 });
        bad = Sample { penalty: 0.0, ..b };
        assert_eq!(err(&[bad, a]), ProblemError::Penalty { index: 0, value: 0.0 });
        bad = b;
        bad.point.covariance = Covariance::isotropic(f64::INFINITY);
        assert_eq!(err(&[a, bad]), ProblemError::EllipsoidNotFinite { index: 1 });
        bad = Sample { radius: 1e300, ..b };
        bad.point.covariance = Covariance::isotropic(1e300);
        assert_eq!(err(&[a, bad]), ProblemError::EllipsoidNotFinite { index: 1 });
        for gamma in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let result = Problem::new(&[a, b], Kernel::Gaussian { gamma });
            assert!(matches!(result, Err(ProblemError::Gamma { .. })), "{gamma}");
        }
    }
}
