//! Eigenvalues and axes of a symmetric 3×3 matrix.

use crate::vectors::{Matrix3, Vector3};

/// Sweeps at most; more than six have not been seen.
pub(super) const MOST_SWEEPS: usize = 20;

/// Eigenvalues and axes (columns) of a symmetric matrix by cyclic Jacobi rotations: for 3×3 several
/// times as fast as a tridiagonal decomposition, and more accurate for small eigenvalues.
pub(crate) fn jacobi(mut m: Matrix3) -> (Vector3, Matrix3) {
    let mut axes = Matrix3::identity();
    // Four are usual: from then on the error is squared each time.
    for _ in 0..MOST_SWEEPS {
        if [(0, 1), (0, 2), (1, 2)].iter().all(|&at| m[at] == 0.0) {
            break;
        }
        // PERF: one after the other, for a loop would not know its rows when it is compiled.
        rotate::<0, 1, 2>(&mut m, &mut axes);
        rotate::<0, 2, 1>(&mut m, &mut axes);
        rotate::<1, 2, 0>(&mut m, &mut axes);
    }
    (m.diagonal(), axes)
}

/// Turns two axes until the entry of both is zero; R is the third.
#[inline(always)]
fn rotate<const P: usize, const Q: usize, const R: usize>(m: &mut Matrix3, axes: &mut Matrix3) {
    let off = m[(P, Q)];
    // What rounds away beside both of its diagonal entries is done with.
    if m[(P, P)] + off == m[(P, P)] && m[(Q, Q)] + off == m[(Q, Q)] {
        (m[(P, Q)], m[(Q, P)]) = (0.0, 0.0);
        return;
    }
    let ratio = (m[(Q, Q)] - m[(P, P)]) / (2.0 * off);
    let tangent = ratio.signum() / (ratio.abs() + (1.0 + ratio * ratio).sqrt());
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let sine = tangent * cosine;
    let (rp, rq) = (m[(R, P)], m[(R, Q)]);
    m[(P, P)] -= tangent * off;
    m[(Q, Q)] += tangent * off;
    (m[(P, Q)], m[(Q, P)]) = (0.0, 0.0);
    m[(R, P)] = cosine * rp - sine * rq;
    m[(R, Q)] = sine * rp + cosine * rq;
    (m[(P, R)], m[(Q, R)]) = (m[(R, P)], m[(R, Q)]);
    for k in 0..3 {
        let (of_p, of_q) = (axes[(k, P)], axes[(k, Q)]);
        axes[(k, P)] = of_p * cosine - of_q * sine;
        axes[(k, Q)] = of_p * sine + of_q * cosine;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    proptest::proptest! {
        #[test]
        fn jacobi_agrees_with_a_tridiagonal_decomposition(
            entries in proptest::array::uniform9(-1.0..1.0_f64),
            stretch in -8..1_i32,
        ) {
            let root = Matrix3::from_row_slice(&entries)
                * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 10_f64.powi(stretch)));
            let matrix = root * root.transpose();
            let (values, axes) = jacobi(matrix);
            let back = axes * Matrix3::from_diagonal(&values) * axes.transpose();
            proptest::prop_assert!((back - matrix).amax() < 1e-14);
            proptest::prop_assert!((axes.transpose() * axes - Matrix3::identity()).amax() < 1e-14);
            let mut expected: Vec<f64> =
                nalgebra::SymmetricEigen::new(matrix).eigenvalues.iter().copied().collect();
            let mut found: Vec<f64> = values.iter().copied().collect();
            expected.sort_by(f64::total_cmp);
            found.sort_by(f64::total_cmp);
            for (expected, found) in expected.iter().zip(&found) {
                proptest::prop_assert!((expected - found).abs() < 1e-13);
            }
        }
    }
}
