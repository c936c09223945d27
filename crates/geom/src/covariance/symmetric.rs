//! Symmetric 3×3 matrices by their six entries, and whether they are positive semidefinite.

use crate::covariance::jacobi::jacobi;
use crate::covariance::jacobi_of_two::jacobi_of_two;
use crate::vectors::{Matrix3, Vector3};

/// A symmetric matrix; semidefinite or not is known where it is used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Symmetric {
    pub(crate) xx: f64,
    pub(crate) xy: f64,
    pub(crate) xz: f64,
    pub(crate) yy: f64,
    pub(crate) yz: f64,
    pub(crate) zz: f64,
}

/// A negative eigenvalue of so much of the largest entry is rounding, and mending it would round
/// again.
const EIGENVALUE_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// By what share [`Symmetric::largest_at_most`] goes beyond what it finds.
const AT_MOST: f64 = 5e-7;

impl Symmetric {
    /// The average of a matrix and its transpose.
    pub(crate) fn average(m: &Matrix3) -> Self {
        Self {
            xx: m[(0, 0)],
            xy: 0.5 * (m[(0, 1)] + m[(1, 0)]),
            xz: 0.5 * (m[(0, 2)] + m[(2, 0)]),
            yy: m[(1, 1)],
            yz: 0.5 * (m[(1, 2)] + m[(2, 1)]),
            zz: m[(2, 2)],
        }
    }

    #[inline]
    pub(crate) fn matrix(&self) -> Matrix3 {
        let Self { xx, xy, xz, yy, yz, zz } = *self;
        Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
    }

    /// Row by row, the upper triangle.
    pub(crate) fn entries(&self) -> [f64; 6] {
        [self.xx, self.xy, self.xz, self.yy, self.yz, self.zz]
    }

    pub(crate) fn scaled(&self, f: f64) -> Self {
        let [xx, xy, xz, yy, yz, zz] = self.entries().map(|entry| entry * f);
        Self { xx, xy, xz, yy, yz, zz }
    }

    #[inline]
    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self {
            xx: self.xx + other.xx,
            xy: self.xy + other.xy,
            xz: self.xz + other.xz,
            yy: self.yy + other.yy,
            yz: self.yz + other.yz,
            zz: self.zz + other.zz,
        }
    }

    /// dᵀ M d.
    pub(crate) fn quadratic(&self, d: &Vector3) -> f64 {
        d.x * (self.xx * d.x + 2.0 * (self.xy * d.y + self.xz * d.z))
            + d.y * (self.yy * d.y + 2.0 * self.yz * d.z)
            + self.zz * d.z * d.z
    }

    /// Eigenvalues, in no order, and the axes (columns) they belong to.
    pub(crate) fn eigen(&self) -> (Vector3, Matrix3) {
        let scale = self.matrix().amax();
        if scale == 0.0 || !scale.is_finite() {
            return (Vector3::repeat(scale), Matrix3::identity());
        }
        // Scaled to unit size: the iteration squares entries, and 1e-160² underflows.
        let (values, axes) = jacobi(self.matrix() / scale);
        (values * scale, axes)
    }

    /// What [`Self::eigen`] says of either, to the bit, in little more than the time of one.
    pub(crate) fn eigen_of_two(two: [&Self; 2]) -> [(Vector3, Matrix3); 2] {
        let scales = two.map(|one| one.matrix().amax());
        if scales.iter().any(|&scale| scale == 0.0 || !scale.is_finite()) {
            return two.map(Self::eigen);
        }
        let [one, other] = [0, 1].map(|k| two[k].matrix() / scales[k]);
        let [one, other] = jacobi_of_two([&one, &other]);
        [(one.0 * scales[0], one.1), (other.0 * scales[1], other.1)]
    }

    /// The largest eigenvalue, or up to a millionth more; much sooner told than by [`Self::eigen`].
    ///
    /// By the angles of the roots of the characteristic polynomial (O. K. Smith, Communications of the ACM 4,
    /// 1961), which are off by the root of what rounding is where the two largest are equal.
    pub(crate) fn largest_at_most(&self) -> f64 {
        let scale = self.matrix().amax();
        if scale == 0.0 || !scale.is_finite() {
            return scale;
        }
        let [xx, xy, xz, yy, yz, zz] = self.entries().map(|entry| entry / scale);
        let mean = (xx + yy + zz) / 3.0;
        let rest = [xx - mean, yy - mean, zz - mean];
        let aside = xy * xy + xz * xz + yz * yz;
        let size = ((rest.iter().map(|r| r * r).sum::<f64>() + 2.0 * aside) / 6.0).sqrt();
        let [x, y, z] = rest;
        let determinant = x * (y * z - yz * yz) - xy * (xy * z - yz * xz) + xz * (xy * yz - y * xz);
        let cosine = 0.5 * determinant / size.powi(3);
        // All are the same where the rest is nothing.
        let angle = if cosine.is_finite() { cosine.clamp(-1.0, 1.0).acos() / 3.0 } else { 0.0 };
        let largest = mean + 2.0 * size * angle.cos();
        scale * (largest + AT_MOST * largest.abs())
    }

    /// The nearest positive semidefinite matrix: negative eigenvalues become zero. What is not
    /// finite stays as it is.
    pub(crate) fn semidefinite(&self) -> Self {
        if self.has_root() || !self.entries().iter().all(|entry| entry.is_finite()) {
            return *self;
        }
        let (values, axes) = self.eigen();
        if values.min() >= -EIGENVALUE_ROUNDING * self.matrix().amax() {
            return Self {
                xx: self.xx.max(0.0),
                yy: self.yy.max(0.0),
                zz: self.zz.max(0.0),
                ..*self
            };
        }
        let values = values.map(|value| value.max(0.0));
        Self::average(&(axes * Matrix3::from_diagonal(&values) * axes.transpose()))
    }

    /// Whether no eigenvalue is larger, up to rounding.
    pub(crate) fn is_within(&self, largest: f64) -> bool {
        let [xx, xy, xz, yy, yz, zz] = self.entries();
        let rest = Self {
            xx: largest - xx,
            xy: -xy,
            xz: -xz,
            yy: largest - yy,
            yz: -yz,
            zz: largest - zz,
        };
        rest.has_root()
    }

    /// Whether a Cholesky decomposition runs to its end, which it does, up to rounding, only where
    /// no eigenvalue is negative (Higham, Accuracy and Stability, theorem 10.3).
    fn has_root(&self) -> bool {
        let Self { xx, xy, xz, yy, yz, zz } = *self;
        let Some([to_y, to_z]) = eliminated(xx, [xy, xz]) else { return false };
        let (yy, yz, zz) = (yy - to_y * xy, yz - to_y * xz, zz - to_z * xz);
        let Some([to_z]) = eliminated(yy, [yz]) else { return false };
        zz - to_z * yz >= 0.0
    }
}

/// The entries beside a pivot over it; `None` where the pivot cannot be one.
fn eliminated<const N: usize>(pivot: f64, beside: [f64; N]) -> Option<[f64; N]> {
    if pivot > 0.0 {
        return Some(beside.map(|entry| entry / pivot));
    }
    (pivot == 0.0 && beside == [0.0; N]).then_some([0.0; N])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn any_symmetric() -> impl Strategy<Value = Symmetric> {
        let entry = prop_oneof![1 => Just(0.0), 4 => -1.0..1.0_f64];
        (prop::array::uniform9(entry), -100..100_i32).prop_map(|(entries, exponent)| {
            Symmetric::average(&(Matrix3::from_row_slice(&entries) * 10_f64.powi(exponent)))
        })
    }

    proptest! {
        #[test]
        fn the_nearest_semidefinite_matrix_is_one(m in any_symmetric()) {
            let mended = m.semidefinite();
            let (scale, least) = (m.matrix().amax(), mended.eigen().0.min());
            prop_assert!(least >= -1e-15 * scale, "{least} of {scale}");
            // Nearest: what was taken away is the negative part, which is across what is left.
            let taken = mended.matrix() - m.matrix();
            prop_assert!((taken * mended.matrix()).amax() <= 1e-14 * scale * scale);
            prop_assert_eq!(mended.semidefinite(), mended);
        }

        #[test]
        fn what_is_semidefinite_stays(m in any_symmetric()) {
            let square = Symmetric::average(&(m.matrix() * m.matrix()));
            let scale = square.matrix().amax();
            prop_assert!((square.semidefinite().matrix() - square.matrix()).amax() <= 1e-15 * scale);
        }

        /// Discs too, whose two largest are equal.
        #[test]
        fn what_is_at_least_the_largest_is_no_more_than_a_millionth_above(
            m in any_symmetric(),
            is_disc in any::<bool>(),
        ) {
            let (_, axes) = m.eigen();
            let square = m.matrix() * m.matrix();
            let across = square.amax();
            let disc = axes * Matrix3::from_diagonal(&Vector3::new(across, 1e-3 * across, across)) * axes.transpose();
            let square = Symmetric::average(if is_disc { &disc } else { &square });
            let (largest, bound) = (square.eigen().0.max(), square.largest_at_most());
            prop_assert!(bound >= largest && bound <= largest * (1.0 + 1e-6), "{bound} of {largest}");
        }
    }
}
