//! The two kernels, and what one expansion term adds to the decision function.

use cloudtouch_geom::{Point3, Vector3};

use crate::lanes::{Lane, Lanes};

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

    /// [`Self::reduced`] of a point with itself.
    #[inline]
    pub(crate) fn reduced_own(&self, x: &Vector3) -> f64 {
        match *self {
            Self::Linear => x.norm_squared(),
            Self::Gaussian { .. } => 0.0,
        }
    }

    /// [`Self::reduced`] of `x` and every one of `places`, to within a few units in the last place.
    pub(crate) fn reduced_row(&self, x: &Vector3, places: &[Lanes; 3], row: &mut [Lane]) {
        pulp::Arch::new().dispatch(Row { kernel: *self, x, places, row });
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

    /// [`Self::influence`] of a point on itself.
    #[inline]
    pub(crate) fn own_influence(&self, x: &Vector3, a: f64, s: &Vector3) -> (f64, Vector3) {
        match *self {
            Self::Linear => self.influence(x, x, self.reduced_own(x), a, s),
            Self::Gaussian { gamma } => (0.0, s * (2.0 * gamma)),
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

/// A row of the kernel matrix to be computed.
struct Row<'a> {
    kernel: Kernel,
    x: &'a Vector3,
    places: &'a [Lanes; 3],
    row: &'a mut [Lane],
}

impl pulp::NullaryFnOnce for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let [xs, ys, zs] = self.places.each_ref().map(Lanes::lanes);
        let from = [self.x.x, self.x.y, self.x.z].map(Lane::splat);
        for (value, ((x, y), z)) in self.row.iter_mut().zip(xs.iter().zip(ys).zip(zs)) {
            let to = [*x, *y, *z];
            *value = match self.kernel {
                Kernel::Linear => from[0] * to[0] + from[1] * to[1] + from[2] * to[2],
                Kernel::Gaussian { gamma } => {
                    let d = [from[0] - to[0], from[1] - to[1], from[2] - to[2]];
                    let squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                    let exponent = Lane::splat(-gamma) * squared;
                    Lane::from_fn(|k| exp_m1_of_negative(exponent.0[k]))
                }
            };
        }
    }
}

/// eˣ − 1 for x ≤ 0, without branches, to a relative error of 4e-16.
///
/// With x = n ln 2 + r it is 2ⁿ(eʳ − 1) + (2ⁿ − 1), and eʳ − 1 its Taylor series for |r| ≤ ½ ln 2.
#[inline(always)]
fn exp_m1_of_negative(x: f64) -> f64 {
    use std::f64::consts::LOG2_E;
    /// ln 2 in two parts, the first short enough that n times it is exact.
    const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
    /// Added to a small number it leaves no place for a fraction: the sum ends in the integer.
    const ROUNDER: f64 = 6_755_399_441_055_744.0;
    /// From here on the result is −1 to the last digit.
    const LEAST: f64 = -40.0;
    let x = if x > LEAST { x } else { LEAST };
    let shifted = x * LOG2_E + ROUNDER;
    let n = shifted - ROUNDER;
    let r = (x - n * LN_2[0]) - n * LN_2[1];
    let mut tail = 1.0 / 6_227_020_800.0;
    for inverse in [
        1.0 / 479_001_600.0,
        1.0 / 39_916_800.0,
        1.0 / 3_628_800.0,
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5_040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
        0.5,
    ] {
        tail = tail * r + inverse;
    }
    let small = r + r * r * tail;
    let power = f64::from_bits((shifted.to_bits() << 52).wrapping_add(1.0_f64.to_bits()));
    power * small + (power - 1.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_exponential_is_that_of_the_library_to_its_last_digits(
            scale in -320.0..4.0_f64,
            digits in 1.0..10.0_f64,
        ) {
            let x = -digits * 10_f64.powf(scale);
            let (fast, slow) = (exp_m1_of_negative(x), x.exp_m1());
            prop_assert!((fast - slow).abs() <= 4e-16 * slow.abs(), "{x}: {fast} for {slow}");
        }

        #[test]
        fn a_row_has_the_reduced_kernel(
            places in prop::collection::vec(prop::array::uniform3(-2.0..2.0_f64), 1..20),
            gamma in -6.0..3.0_f64,
        ) {
            let points: Vec<Vector3> = places.into_iter().map(Vector3::from).collect();
            let of = |axis: usize| Lanes::new(points.iter().map(|p| p[axis]));
            let (lanes, mut row) = ([of(0), of(1), of(2)], Lanes::default());
            for kernel in [Kernel::Linear, Kernel::Gaussian { gamma: 10_f64.powf(gamma) }] {
                row.reset(points.len());
                kernel.reduced_row(&points[0], &lanes, row.lanes_mut());
                prop_assert_eq!(row.at(0), kernel.reduced_own(&points[0]));
                for (k, point) in points.iter().enumerate() {
                    let slow = kernel.reduced(&points[0], point);
                    prop_assert!((row.at(k) - slow).abs() <= 1e-15 * slow.abs().max(1e-300)
                        || kernel == Kernel::Linear && (row.at(k) - slow).abs() <= 1e-14);
                }
            }
        }
    }

    #[test]
    fn the_exponential_of_the_ends_is_exact() {
        for (x, expected) in [(0.0, 0.0), (-0.0, 0.0), (-50.0, -1.0), (f64::NEG_INFINITY, -1.0)] {
            assert_eq!(exp_m1_of_negative(x), expected, "{x}");
        }
    }

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
