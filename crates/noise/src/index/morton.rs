//! The curve of Morton: bits of three coordinates in turn, so that what is near on it is near in space.

/// Bits of each coordinate that fit.
const BITS: u32 = 21;

/// The place on the curve of the cell with these coordinates: the highest bit of three is of the first.
pub(crate) fn interleaved([x, y, z]: [u64; 3]) -> u64 {
    spread(x) << 2 | spread(y) << 1 | spread(z)
}

/// The coordinates of the cell at a place on the curve.
pub(crate) fn coordinates(place: u64) -> [u64; 3] {
    [2, 1, 0].map(|axis| gathered(place >> axis))
}

/// The lowest bits of a number with two zeros before each.
fn spread(value: u64) -> u64 {
    let mut value = value & ((1 << BITS) - 1);
    value = (value | value << 32) & 0x001F_0000_0000_FFFF;
    value = (value | value << 16) & 0x001F_0000_FF00_00FF;
    value = (value | value << 8) & 0x100F_00F0_0F00_F00F;
    value = (value | value << 4) & 0x10C3_0C30_C30C_30C3;
    (value | value << 2) & 0x1249_2492_4924_9249
}

/// Every third bit of a number, from the lowest on.
fn gathered(value: u64) -> u64 {
    let mut value = value & 0x1249_2492_4924_9249;
    value = (value | value >> 2) & 0x10C3_0C30_C30C_30C3;
    value = (value | value >> 4) & 0x100F_00F0_0F00_F00F;
    value = (value | value >> 8) & 0x001F_0000_FF00_00FF;
    value = (value | value >> 16) & 0x001F_0000_0000_FFFF;
    (value | value >> 32) & ((1 << BITS) - 1)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn coordinates_come_back_and_halves_follow_one_another(
            cell in prop::array::uniform3(0_u64..1 << BITS),
        ) {
            let place = interleaved(cell);
            prop_assert_eq!(coordinates(place), cell);
            // The cell twice as wide is an eighth as far on a curve an eighth as long.
            prop_assert_eq!(interleaved(cell.map(|at| at >> 1)), place >> 3);
        }
    }
}
