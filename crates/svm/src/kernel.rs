//! The two kernels, and what one expansion term adds to the decision function.

use cloudtouch_geom::Vector3;

/// The kernel k(x, y) of the classifier.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    /// k(x, y).
    #[inline]
    pub(crate) fn value(&self, x: &Vector3, y: &Vector3) -> f64 {
        match *self {
            Self::Linear => x.dot(y),
            Self::Gaussian { gamma } => (-gamma * (x - y).norm_squared()).exp(),
        }
    }

    /// Value and gradient at `to` of the term with weight `a` (cα) and displacement `s` (S v) at
    /// `from` (eq. 14); `k` is the kernel value of the two points.
    #[inline]
    pub(crate) fn influence(
        &self,
        from: &Vector3,
        to: &Vector3,
        k: f64,
        a: f64,
        s: &Vector3,
    ) -> (f64, Vector3) {
        match *self {
            Self::Linear => {
                let w = from * a + s;
                (w.dot(to), w)
            }
            Self::Gaussian { gamma } => {
                let d = from - to;
                let t = a - 2.0 * gamma * s.dot(&d);
                (k * t, (d * t + s) * (2.0 * gamma * k))
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
                let slope =
                    (kernel.value(&(x + s * h), to) - kernel.value(&(x - s * h), to)) / (2.0 * h);
                a * kernel.value(&x, to) + slope
            };
            let (value, gradient) = kernel.influence(&x, &y, kernel.value(&x, &y), a, &s);
            assert!((value - term(&y)).abs() < 1e-9);
            for axis in 0..3 {
                let mut step = Vector3::zeros();
                step[axis] = 1e-4;
                let slope = (term(&(y + step)) - term(&(y - step))) / 2e-4;
                assert!((gradient[axis] - slope).abs() < 1e-5, "{kernel:?} axis {axis}");
            }
        }
    }
}
