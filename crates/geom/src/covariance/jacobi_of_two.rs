//! Eigenvalues and axes of two symmetric 3×3 matrices at once.

use wide::f64x2;

use crate::covariance::jacobi::MOST_SWEEPS;
use crate::vectors::{Matrix3, Vector3};

/// One number of each.
type Two = f64x2;

/// Two matrices on their way to diagonal ones.
struct Pair {
    diagonal: [Two; 3],
    /// Each entry off it by the axis that has no part in it.
    off: [Two; 3],
    /// Columns.
    axes: [[Two; 3]; 3],
}

/// What [`jacobi`](super::jacobi::jacobi) says of either, to the bit.
///
/// PERF: each rotation waits for the divisions and roots of the last, so that two take little longer
/// than one.
pub(crate) fn jacobi_of_two([one, other]: [&Matrix3; 2]) -> [(Vector3, Matrix3); 2] {
    let entry = |row, column| Two::new([one[(row, column)], other[(row, column)]]);
    let [nothing, unit] = [0.0, 1.0].map(Two::splat);
    let mut pair = Pair {
        diagonal: [entry(0, 0), entry(1, 1), entry(2, 2)],
        off: [entry(1, 2), entry(0, 2), entry(0, 1)],
        axes: [0, 1, 2].map(|k| {
            let mut axis = [nothing; 3];
            axis[k] = unit;
            axis
        }),
    };
    for _ in 0..MOST_SWEEPS {
        if pair.off.iter().all(|off| off.simd_eq(nothing).all()) {
            break;
        }
        pair.rotate::<0, 1, 2>();
        pair.rotate::<0, 2, 1>();
        pair.rotate::<1, 2, 0>();
    }
    [0, 1].map(|lane| {
        let of = |two: &Two| two.to_array()[lane];
        let values = Vector3::from_fn(|k, _| of(&pair.diagonal[k]));
        (values, Matrix3::from_fn(|row, column| of(&pair.axes[column][row])))
    })
}

impl Pair {
    /// Turns two axes until the entry of both is zero; R is the third. A matrix of which that is done with
    /// stays as it is.
    #[inline(always)]
    fn rotate<const P: usize, const Q: usize, const R: usize>(&mut self) {
        let Self { diagonal, off: entries, axes } = self;
        let (p, q, off) = (diagonal[P], diagonal[Q], entries[R]);
        let is_done = (p + off).simd_eq(p) & (q + off).simd_eq(q);
        entries[R] = Two::splat(0.0);
        if is_done.all() {
            return;
        }
        let unit = Two::splat(1.0);
        let ratio = (q - p) / (Two::splat(2.0) * off);
        let tangent = unit.flip_signs(ratio) / (ratio.abs() + (unit + ratio * ratio).sqrt());
        let cosine = unit / (unit + tangent * tangent).sqrt();
        let sine = tangent * cosine;
        let turned = |of_p: Two, of_q: Two| {
            let turned = [of_p * cosine - of_q * sine, of_p * sine + of_q * cosine];
            [is_done.bitselect(of_p, turned[0]), is_done.bitselect(of_q, turned[1])]
        };
        diagonal[P] = is_done.bitselect(p, p - tangent * off);
        diagonal[Q] = is_done.bitselect(q, q + tangent * off);
        [entries[Q], entries[P]] = turned(entries[Q], entries[P]);
        for k in 0..3 {
            [axes[P][k], axes[Q][k]] = turned(axes[P][k], axes[Q][k]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::covariance::jacobi::jacobi;

    proptest::proptest! {
        #[test]
        fn two_at_once_are_each_by_itself(
            entries in proptest::array::uniform2(proptest::array::uniform6(
                proptest::prop_oneof![1 => proptest::strategy::Just(0.0), 3 => -1.0..1.0_f64],
            )),
            stretch in -8..1_i32,
        ) {
            let [one, other] = entries.map(|[xx, xy, xz, yy, yz, zz]| {
                Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
            });
            let other = other * 10_f64.powi(stretch);
            let bits = |(values, axes): (Vector3, Matrix3)| {
                (values.map(f64::to_bits), axes.map(f64::to_bits))
            };
            let expected = [one, other].map(|matrix| bits(jacobi(matrix)));
            proptest::prop_assert_eq!(jacobi_of_two([&one, &other]).map(bits), expected);
        }
    }
}
