//! The two kernels, and what one expansion term adds to the decision function.

use cloudtouch_geom::{Point3, Vector3};

/// The kernel k(x, y) of the classifier.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Kernel {
    /// k = x·y: the surface is a plane.
    Linear,
    /// k = exp(−γ|x−y|²).
    Gaussian {
        /// γ, per squared unit of length; 5 to 20 serves pairs scaled to the unit box.
        gamma: f64,
    },
}

impl Kernel {
    /// k(x, y). A problem takes positions [relative to its centre](crate::Problem::centre), which
    /// matters for the linear kernel alone.
    pub fn value(&self, x: &Point3, y: &Point3) -> f64 {
        match *self {
            Self::Linear => x.coords.dot(&y.coords),
            Self::Gaussian { gamma } => (-gamma * (x - y).norm_squared()).exp(),
        }
    }

    /// k less its constant: k − 1 for the Gaussian kernel, k for the linear one.
    ///
    /// With Σ cα = 0 a constant adds nothing to the decision function, but it would take its digits
    /// away where γ|x−y|² is small: k is 1 there up to rounding, and 2 − 2k nothing but rounding.
    #[inline]
    pub(crate) fn reduced(&self, x: &Vector3, y: &Vector3) -> f64 {
        match *self {
            Self::Linear => x.dot(y),
            Self::Gaussian { gamma } => (-gamma * (x - y).norm_squared()).exp_m1(),
        }
    }

    /// Value and gradient at `to` of the term with weight `a` (cα) and displacement `s` (S v) at
    /// `from` (eq. 14), its constant left out; `reduced` is [`Self::reduced`] of the two points.
    #[inline]
    pub(crate) fn influence(
        &self,
        from: &Vector3,
        to: &Vector3,
        reduced: f64,
        a: f64,
        s: &Vector3,
    ) -> (f64, Vector3) {
        match *self {
            Self::Linear => {
                let w = from * a + s;
                (w.dot(to), w)
            }
            Self::Gaussian { gamma } => {
                let k = 1.0 + reduced;
                let d = from - to;
                let pull = -2.0 * gamma * s.dot(&d);
                (a * reduced + k * pull, (d * (a + pull) + s) * (2.0 * gamma * k))
            }
        }
    }

    /// The factor between a displacement at a point and the gradient it causes there: 2γ, or 1 for
    /// the linear kernel.
    #[inline]
    pub(crate) fn self_curvature(&self) -> f64 {
        match *self {
            Self::Linear => 1.0,
            Self::Gaussian { gamma } => 2.0 * gamma,
        }
    }

    /// |φ(x) − φ(y)|²: 2 − 2k, or |x − y|² for the linear kernel; `reduced` is [`Self::reduced`] of
    /// the two points.
    #[inline]
    pub(crate) fn squared_distance(&self, x: &Vector3, y: &Vector3, reduced: f64) -> f64 {
        match self {
            Self::Linear => (x - y).norm_squared(),
            Self::Gaussian { .. } => -2.0 * reduced,
        }
    }

    /// |φ(x) − φ(0)|².
    pub(crate) fn squared_reach(&self, x: &Vector3) -> f64 {
        let zero = Vector3::zeros();
        self.squared_distance(x, &zero, self.reduced(x, &zero))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn influence_is_the_derivative_of_the_kernel() {
        // A displacement s stands for a·k with the source moved along s: compare with differences.
        let (x, y) = (Vector3::new(0.3, -0.2, 0.5), Vector3::new(-0.1, 0.4, 0.2));
        let (a, s) = (0.7, Vector3::new(0.2, 0.1, -0.4));
        for kernel in [Kernel::Linear, Kernel::Gaussian { gamma: 1.7 }] {
            let term = |to: &Vector3| {
                let h = 1e-5;
                let slope = (kernel.reduced(&(x + s * h), to) - kernel.reduced(&(x - s * h), to))
                    / (2.0 * h);
                a * kernel.reduced(&x, to) + slope
            };
            let (value, gradient) = kernel.influence(&x, &y, kernel.reduced(&x, &y), a, &s);
            assert!((value - term(&y)).abs() < 1e-9);
            for axis in 0..3 {
                let mut step = Vector3::zeros();
                step[axis] = 1e-4;
                let slope = (term(&(y + step)) - term(&(y - step))) / 2e-4;
                assert!((gradient[axis] - slope).abs() < 1e-5, "{kernel:?} axis {axis}");
            }
        }
    }

    #[test]
    fn the_reduced_kernel_is_the_kernel_less_one_and_keeps_its_digits() {
        let (x, y) = (Vector3::new(0.3, -0.2, 0.5), Vector3::new(-0.1, 0.4, 0.2));
        let squared = (x - y).norm_squared();
        for gamma in [1e-300, 1e-20, 1e-8, 0.1, 3.0] {
            let kernel = Kernel::Gaussian { gamma };
            let reduced = kernel.reduced(&x, &y);
            assert!((kernel.value(&x.into(), &y.into()) - (1.0 + reduced)).abs() < 1e-15);
            if gamma < 1e-7 {
                assert!((reduced / (-gamma * squared) - 1.0).abs() < 1e-7);
            }
        }
        assert_eq!(Kernel::Linear.value(&x.into(), &y.into()), Kernel::Linear.reduced(&x, &y));
    }
}
