//! The Cholesky factor of a dense positive definite matrix, in panels of rows that fill a lane.
//!
//! For the few hundred variables of a leaf problem the packing and the recursion of a general library
//! take longer than the arithmetic.

use crate::lanes::{Lane, WIDTH};

/// The lower triangle of a symmetric matrix or its factor, L with L Lᵀ the matrix.
///
/// Panel after panel of eight rows; of each panel the columns from the first to the last of its
/// diagonal block, each a lane. What the last panel has beyond the matrix is that of the identity.
#[derive(Debug, Clone, Default)]
pub(crate) struct Panels {
    size: usize,
    lanes: Vec<Lane>,
}

impl Panels {
    /// The matrix of this size whose entries are 0.
    pub(crate) fn zeros(size: usize) -> Self {
        let count = size.div_ceil(WIDTH);
        let mut panels = Self { size, lanes: vec![Lane::ZERO; begin(count)] };
        for beyond in size..WIDTH * count {
            *panels.entry(beyond, beyond) = 1.0;
        }
        panels
    }

    /// How many rows it has.
    pub(crate) fn size(&self) -> usize {
        self.size
    }

    /// Becomes a copy, in its own memory.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.size = other.size;
        self.lanes.clear();
        self.lanes.extend_from_slice(&other.lanes);
    }

    /// An entry of the matrix.
    #[cfg(any(test, feature = "clarabel"))]
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        let (row, column) = (row.max(column), row.min(column));
        self.lanes[begin(row / WIDTH) + column].0[row % WIDTH]
    }

    /// An entry on or below the diagonal.
    pub(crate) fn entry(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.lanes[begin(row / WIDTH) + column].0[row % WIDTH]
    }

    /// The product of the matrix, not of its factor, with a vector.
    pub(crate) fn product(&self, vector: &[f64], product: &mut [f64], memory: &mut Vec<Lane>) {
        let count = self.size.div_ceil(WIDTH);
        memory.clear();
        memory.resize(2 * count, Lane::ZERO);
        let (x, y) = memory.split_at_mut(count);
        for (lane, values) in x.iter_mut().zip(vector.chunks(WIDTH)) {
            lane.0[..values.len()].copy_from_slice(values);
        }
        pulp::Arch::new().dispatch(Product { lanes: &self.lanes, x, y });
        for (lane, values) in y.iter().zip(product.chunks_mut(WIDTH)) {
            values.copy_from_slice(&lane.0[..values.len()]);
        }
    }

    /// Replaces the matrix by its factor; `None`, with nothing of use left, when it is not positive
    /// definite.
    pub(crate) fn factor(&mut self) -> Option<()> {
        pulp::Arch::new().dispatch(Factor { lanes: &mut self.lanes })
    }

    /// Solves for a right side, of the factored matrix.
    pub(crate) fn solve(&self, right: &mut [f64], padded: &mut Vec<Lane>) {
        padded.clear();
        padded.resize(self.size.div_ceil(WIDTH), Lane::ZERO);
        for (lane, values) in padded.iter_mut().zip(right.chunks(WIDTH)) {
            lane.0[..values.len()].copy_from_slice(values);
        }
        pulp::Arch::new().dispatch(Solve { lanes: &self.lanes, x: padded });
        for (lane, values) in padded.iter().zip(right.chunks_mut(WIDTH)) {
            values.copy_from_slice(&lane.0[..values.len()]);
        }
    }
}

/// Where a panel begins.
fn begin(panel: usize) -> usize {
    WIDTH * panel * (panel + 1) / 2
}

type Block = [Lane; WIDTH];

/// Panels of a strip.
const STRIP: usize = 8;

struct Factor<'a> {
    lanes: &'a mut [Lane],
}

impl pulp::WithSimd for Factor<'_> {
    type Output = Option<()>;

    /// Left-looking, eight columns after the other. What the columns before a strip of them add is
    /// taken off for the whole strip at once, so that a large matrix is not read anew for each.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Option<()> {
        let lanes = self.lanes;
        let mut first = 0;
        while begin(first) < lanes.len() {
            let left = WIDTH * first;
            let mut panel = first;
            while left > 0 && begin(panel) < lanes.len() {
                let (others, this) = lanes.split_at_mut(begin(panel));
                let this = &mut this[..WIDTH * (panel + 1)];
                for column in first..(first + STRIP).min(panel + 1) {
                    let (entries, target) = this.split_at_mut(left);
                    let pivots = if column == panel { &*entries } else { &others[begin(column)..] };
                    let target = &mut target[WIDTH * (column - first)..][..WIDTH];
                    let mut block = load(target);
                    reduce::<S>(&mut block, entries, &pivots[..left]);
                    target.copy_from_slice(&block);
                }
                panel += 1;
            }
            for column in first..first + STRIP {
                if begin(column) >= lanes.len() {
                    break;
                }
                factor_columns::<S>(lanes, left, column)?;
            }
            first += STRIP;
        }
        Some(())
    }
}

/// Finishes eight columns of a strip, of which all before the one at `left` have been taken off.
#[inline(always)]
fn factor_columns<S: pulp::Simd>(lanes: &mut [Lane], left: usize, column: usize) -> Option<()> {
    let own = WIDTH * column;
    let (upper, lower) = lanes.split_at_mut(begin(column + 1));
    let (before, diagonal) = upper[begin(column)..].split_at_mut(own);
    let before = &before[left..];
    let mut block = load(diagonal);
    reduce::<S>(&mut block, before, before);
    let mut inverse = [0.0; WIDTH];
    for k in 0..WIDTH {
        let pivot = block[k].0[k];
        // A pivot that is not a number fails too.
        if !(pivot > 0.0 && pivot.is_finite()) {
            return None;
        }
        inverse[k] = 1.0 / pivot.sqrt();
        block[k] = block[k] * Lane::splat(inverse[k]);
        for later in k + 1..WIDTH {
            block[later] = block[later] - block[k] * Lane::splat(block[k].0[later]);
        }
    }
    diagonal.copy_from_slice(&block);
    let pivots = block;
    let mut panels = lower;
    let mut width = own + 2 * WIDTH;
    while !panels.is_empty() {
        let (panel, rest) = panels.split_at_mut(width);
        let (entries, target) = panel.split_at_mut(own);
        let target = &mut target[..WIDTH];
        let mut block = load(target);
        reduce::<S>(&mut block, &entries[left..], before);
        eliminate::<0>(&mut block, &pivots, &inverse);
        eliminate::<1>(&mut block, &pivots, &inverse);
        eliminate::<2>(&mut block, &pivots, &inverse);
        eliminate::<3>(&mut block, &pivots, &inverse);
        eliminate::<4>(&mut block, &pivots, &inverse);
        eliminate::<5>(&mut block, &pivots, &inverse);
        eliminate::<6>(&mut block, &pivots, &inverse);
        eliminate::<7>(&mut block, &pivots, &inverse);
        target.copy_from_slice(&block);
        panels = rest;
        width += WIDTH;
    }
    Some(())
}

#[inline(always)]
fn load(lanes: &[Lane]) -> Block {
    let mut block = [Lane::ZERO; WIDTH];
    block.copy_from_slice(&lanes[..WIDTH]);
    block
}

/// block −= rows · columnsᵀ.
#[inline(always)]
fn reduce<S: pulp::Simd>(block: &mut Block, rows: &[Lane], columns: &[Lane]) {
    if S::F64_LANES >= WIDTH {
        reduce_part::<S, WIDTH>(block, rows, columns, 0);
    } else {
        // Half of the columns at a time, for want of registers.
        reduce_part::<S, { WIDTH / 2 }>(block, rows, columns, 0);
        reduce_part::<S, { WIDTH / 2 }>(block, rows, columns, WIDTH / 2);
    }
}

#[inline(always)]
fn reduce_part<S: pulp::Simd, const COLUMNS: usize>(
    block: &mut Block,
    rows: &[Lane],
    columns: &[Lane],
    first: usize,
) {
    let mut sums = [Lane::ZERO; COLUMNS];
    for (row, column) in rows.iter().zip(columns) {
        for c in 0..COLUMNS {
            for k in 0..WIDTH {
                sums[c].0[k] = multiply_add::<S>(row.0[k], column.0[first + c], sums[c].0[k]);
            }
        }
    }
    for c in 0..COLUMNS {
        block[first + c] = block[first + c] - sums[c];
    }
}

/// ab + c, in one instruction where the processor has it; elsewhere that would be a slow function.
#[inline(always)]
fn multiply_add<S: pulp::Simd>(a: f64, b: f64, c: f64) -> f64 {
    if S::F64_LANES >= 4 { a.mul_add(b, c) } else { a * b + c }
}

/// Scales column `K` and takes it out of those after it. The number is a constant, so that the block
/// stays in registers.
#[inline(always)]
fn eliminate<const K: usize>(block: &mut Block, pivots: &Block, inverse: &[f64; WIDTH]) {
    block[K] = block[K] * Lane::splat(inverse[K]);
    for later in K + 1..WIDTH {
        block[later] = block[later] - block[K] * Lane::splat(pivots[K].0[later]);
    }
}

struct Product<'a> {
    lanes: &'a [Lane],
    x: &'a [Lane],
    y: &'a mut [Lane],
}

impl pulp::NullaryFnOnce for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { lanes, x, y } = self;
        for panel in 0..x.len() {
            let rows = &lanes[begin(panel)..begin(panel + 1)];
            let (others, this) = y.split_at_mut(panel);
            let mut sums = [Lane::ZERO; 2];
            for (c, block) in rows[..WIDTH * panel].chunks_exact(WIDTH).enumerate() {
                for k in 0..WIDTH {
                    sums[k % 2] += block[k] * Lane::splat(x[c].0[k]);
                    others[c].0[k] += (block[k] * x[panel]).sum();
                }
            }
            // Of the diagonal block only the lower half is stored.
            let diagonal = &rows[WIDTH * panel..];
            for k in 0..WIDTH {
                sums[0] += diagonal[k] * Lane::splat(x[panel].0[k]);
                for later in k + 1..WIDTH {
                    sums[1].0[k] += diagonal[k].0[later] * x[panel].0[later];
                }
            }
            this[0] += sums[0] + sums[1];
        }
    }
}

struct Solve<'a> {
    lanes: &'a [Lane],
    x: &'a mut [Lane],
}

impl pulp::NullaryFnOnce for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { lanes, x } = self;
        for panel in 0..x.len() {
            let (known, unknown) = x.split_at_mut(panel);
            let rows = &lanes[begin(panel)..begin(panel + 1)];
            let mut value = unknown[0];
            for (block, known) in rows.chunks_exact(WIDTH).zip(known.iter()) {
                // Two sums, so that one addition need not wait for the other.
                let mut sums = [Lane::ZERO; 2];
                for k in 0..WIDTH {
                    sums[k % 2] += block[k] * Lane::splat(known.0[k]);
                }
                value = value - (sums[0] + sums[1]);
            }
            let diagonal = &rows[WIDTH * panel..];
            for k in 0..WIDTH {
                let solved = value.0[k] / diagonal[k].0[k];
                value = value - diagonal[k] * Lane::splat(solved);
                value.0[k] = solved;
                unknown[0].0[k] = solved;
            }
        }
        for panel in (0..x.len()).rev() {
            let (others, this) = x.split_at_mut(panel);
            let rows = &lanes[begin(panel)..begin(panel + 1)];
            let diagonal = &rows[WIDTH * panel..];
            let mut value = this[0];
            for k in (0..WIDTH).rev() {
                let mut rest = value.0[k];
                for later in k + 1..WIDTH {
                    rest -= diagonal[k].0[later] * value.0[later];
                }
                value.0[k] = rest / diagonal[k].0[k];
            }
            this[0] = value;
            for (block, other) in rows.chunks_exact(WIDTH).zip(others.iter_mut()) {
                for k in 0..WIDTH {
                    other.0[k] -= (block[k] * value).sum();
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use proptest::prelude::*;

    use super::*;

    fn of(size: usize, value: impl Fn(usize, usize) -> f64) -> Panels {
        let mut panels = Panels::zeros(size);
        for row in 0..size {
            for column in 0..=row {
                *panels.entry(row, column) = value(row, column);
            }
        }
        panels
    }

    proptest! {
        #[test]
        fn it_solves_as_the_library_does(
            size in 1..150_usize,
            values in prop::collection::vec(-1.0..1.0_f64, 150 * 151),
        ) {
            let half = DMatrix::from_fn(size, size, |r, c| values[150 * r + c]);
            let matrix = &half * half.transpose() + DMatrix::identity(size, size) * 0.1;
            let right = &values[150 * 150..][..size];
            let reference = matrix.clone().cholesky().unwrap();
            let expected = reference.solve(&DVector::from_column_slice(right));
            let mut panels = of(size, |r, c| matrix[(r, c)]);
            prop_assert_eq!(panels.at(0, size - 1), matrix[(size - 1, 0)]);
            let (mut found, mut memory) = (vec![0.0; size], Vec::new());
            panels.product(right, &mut found, &mut memory);
            for row in 0..size {
                let of_row: f64 = (0..size).map(|k| matrix[(row, k)] * right[k]).sum();
                prop_assert!((found[row] - of_row).abs() <= 1e-12 * size as f64);
            }
            panels.factor().unwrap();
            found.copy_from_slice(right);
            panels.solve(&mut found, &mut memory);
            let scale = (0..size).map(|k| expected[k].abs()).fold(1.0, f64::max);
            for k in 0..size {
                prop_assert!((found[k] - expected[k]).abs() <= 1e-10 * scale);
            }
        }

        #[test]
        fn what_is_not_positive_definite_is_refused(size in 1..30_usize, at in 0..30_usize) {
            for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
                let at = at % size;
                let entry = |r, c| if r != c { 0.0 } else if r == at { value } else { 1.0 };
                prop_assert_eq!(of(size, entry).factor(), None);
            }
        }
    }
}
