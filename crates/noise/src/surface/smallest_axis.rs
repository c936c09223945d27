//! The axis of least extent of a symmetric 3×3 matrix, in closed form.

use std::f64::consts::FRAC_PI_3;

use cloudtouch_geom::{Matrix3, Vector3};

/// The unit eigenvector of the smallest eigenvalue of a symmetric positive semidefinite matrix,
/// of either sign; `None` where no axis stands out, as for a ball or a line.
///
/// The eigenvalue is a root of the characteristic polynomial, and the axis from the cross product of two rows of M − λI: a third of the time of an
/// iterative decomposition.
#[inline(always)]
pub(crate) fn smallest_axis(matrix: &Matrix3) -> Option<Vector3> {
    let mean = (matrix[(0, 0)] + matrix[(1, 1)] + matrix[(2, 2)]) / 3.0;
    if mean.is_nan() || mean <= 0.0 {
        return None;
    }
    // Scaled to mean 1, so that neither tiny nor huge clouds leave the range of the products.
    let scale = 1.0 / mean;
    let entry = |row: usize, column: usize| matrix[(row, column)] * scale;
    let [xx, xy, xz] = [entry(0, 0), entry(0, 1), entry(0, 2)];
    let [yy, yz, zz] = [entry(1, 1), entry(1, 2), entry(2, 2)];
    let [dx, dy, dz] = [xx - 1.0, yy - 1.0, zz - 1.0];
    let squares = dx * dx + dy * dy + dz * dz + 2.0 * (xy * xy + xz * xz + yz * yz);
    let spread_squared = squares / 6.0;
    if spread_squared.is_nan() || spread_squared < f64::EPSILON * f64::EPSILON {
        return None;
    }
    let entries = [xx, xy, xz, yy, yz, zz];
    let smallest = match least_root(entries) {
        Some(root) => root,
        None => trigonometric_root(entries, spread_squared.sqrt()),
    };
    let [xx, yy, zz] = [xx - smallest, yy - smallest, zz - smallest];
    // The cross products of the rows of M − λI, two at a time.
    let yx_zx = xy * yz - xz * yy;
    let yx_zy = xz * xy - xx * yz;
    let yy_zz = xx * yy - xy * xy;
    let first = Vector3::new(yx_zx, yx_zy, yy_zz);
    let second = Vector3::new(yy * zz - yz * yz, yz * xz - xy * zz, xy * yz - yy * xz);
    let third = Vector3::new(yz * xz - zz * xy, zz * xx - xz * xz, xz * xy - yz * xx);
    let mut longest = first;
    let mut squared = first.norm_squared();
    for other in [second, third] {
        let other_squared = other.norm_squared();
        if other_squared > squared {
            (longest, squared) = (other, other_squared);
        }
    }
    // The length is the product of the gaps to the other eigenvalues, up to a small factor; below
    // rounding the two smallest are equal.
    let length = squared.sqrt();
    (length > GAP * spread_squared).then(|| longest / length)
}

/// The smallest eigenvalue of a symmetric matrix of trace 3, given by its entries, by the formula
/// for three real roots, which is accurate for one that stands apart.
#[cold]
fn trigonometric_root([xx, xy, xz, yy, yz, zz]: [f64; 6], spread: f64) -> f64 {
    let deviator = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) - Matrix3::identity();
    let half_determinant = (0.5 * (deviator / spread).determinant()).clamp(-1.0, 1.0);
    let angle = half_determinant.acos() / 3.0 + 2.0 * FRAC_PI_3;
    1.0 + 2.0 * spread * angle.cos()
}

/// Newton steps before the trigonometric formula is asked.
const STEPS: usize = 7;
/// A step so small, of a root whose scale is one, ends the search: the next would be its square.
const LAST_STEP: f64 = 1e-9;

/// The smallest eigenvalue of a semidefinite matrix of trace 3, by Newton's method on its
/// characteristic polynomial; `None` where that converges slowly, as for two equal eigenvalues.
///
/// From zero up to the smallest root the polynomial is increasing and concave, so no step goes too
/// far. For a flat patch the first one is almost all.
#[inline(always)]
fn least_root([xx, xy, xz, yy, yz, zz]: [f64; 6]) -> Option<f64> {
    let [minor_x, minor_y, minor_z] = [yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy];
    let minors = minor_x + minor_y + minor_z;
    let determinant = xx * minor_x - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    let mut root = 0.0;
    for _ in 0..STEPS {
        let value = ((root - 3.0) * root + minors) * root - determinant;
        let slope = (3.0 * root - 6.0) * root + minors;
        let step = -value / slope;
        root += step;
        if step.abs() < LAST_STEP {
            return Some(root);
        }
    }
    None
}

/// Least product of the two gaps, relative to the spread squared. Where two eigenvalues are equal the
/// trigonometric formula leaves gaps of 1e-8, the root of the rounding: places on one line would get
/// a plane, another one in each frame.
const GAP: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Covariance;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn agrees_with_an_iterative_decomposition(
            entries in prop::array::uniform9(-1.0..1.0_f64),
            exponent in -12..12_i32,
        ) {
            let root = Matrix3::from_row_slice(&entries) * 10_f64.powi(exponent);
            let matrix = root * root.transpose();
            let (values, axes) = Covariance::from_symmetric(&matrix).eigen();
            prop_assume!(values[1] - values[2] > 1e-4 * values[0]);
            let axis = smallest_axis(&matrix).unwrap();
            prop_assert!(1.0 - axis.dot(&axes.column(2)).abs() < 1e-9);
        }
    }

    #[test]
    fn finds_the_exact_normal_of_a_plane() {
        let normal = Vector3::new(1.0, 2.0, -2.0) / 3.0;
        let axis = smallest_axis(&(Matrix3::identity() - normal * normal.transpose())).unwrap();
        assert!((axis.dot(&normal).abs() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn balls_lines_and_nothing_have_no_smallest_axis() {
        for diagonal in [[1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [f64::NAN; 3]] {
            let matrix = Matrix3::from_diagonal(&Vector3::from(diagonal));
            assert_eq!(smallest_axis(&matrix), None, "{diagonal:?}");
        }
    }
}
