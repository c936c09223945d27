//! Square matrices in memory that a thread keeps from one solve to the next: to be given pages of memory
//! anew takes a sixth of a solve of 2 × 20 points.

use std::cell::RefCell;

use faer::{MatMut, MatRef};

/// Numbers in a line of the cache, which every column begins with.
const LINE: usize = 8;
/// Matrices of the interior point method.
const MOST_KEPT: usize = 2;
/// No larger memory is kept, in numbers (8 MB): 2 × 125 points.
const LARGEST_KEPT: usize = 1 << 20;

thread_local! {
    static KEPT: RefCell<Vec<Vec<f64>>> = const { RefCell::new(Vec::new()) };
}

/// A square matrix, its columns one after another.
pub(crate) struct Square {
    values: Vec<f64>,
    /// Where the first column begins.
    begin: usize,
    /// From the beginning of a column to that of the next.
    stride: usize,
    size: usize,
}

impl Square {
    pub(crate) fn zeros(size: usize) -> Self {
        let stride = size.next_multiple_of(LINE);
        let mut values = KEPT.with_borrow_mut(Vec::pop).unwrap_or_default();
        values.clear();
        values.resize(stride * size + LINE, 0.0);
        let begin = values.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE);
        Self { values, begin, stride, size }
    }

    pub(crate) fn size(&self) -> usize {
        self.size
    }

    pub(crate) fn as_ref(&self) -> MatRef<'_, f64> {
        let values = &self.values[self.begin..self.begin + self.stride * self.size];
        MatRef::from_column_major_slice_with_stride(values, self.size, self.size, self.stride)
    }

    pub(crate) fn as_mut(&mut self) -> MatMut<'_, f64> {
        let values = &mut self.values[self.begin..self.begin + self.stride * self.size];
        MatMut::from_column_major_slice_with_stride_mut(values, self.size, self.size, self.stride)
    }

    /// A column.
    pub(crate) fn column_mut(&mut self, column: usize) -> &mut [f64] {
        let begin = self.begin + column * self.stride;
        &mut self.values[begin..begin + self.size]
    }
}

impl Drop for Square {
    fn drop(&mut self) {
        if self.values.capacity() > LARGEST_KEPT {
            return;
        }
        let values = std::mem::take(&mut self.values);
        // A thread that ends has nothing left to keep it in.
        let _ = KEPT.try_with(|kept| {
            let mut kept = kept.borrow_mut();
            if kept.len() < MOST_KEPT {
                kept.push(values);
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_that_was_kept_begins_anew() {
        for size in [40, 3, 17, 33] {
            let mut square = Square::zeros(size);
            let values = square.as_ref();
            assert!((0..size).all(|j| (0..size).all(|i| values[(i, j)] == 0.0)));
            for column in 0..size {
                let values = square.column_mut(column);
                assert!(values.as_ptr().addr().is_multiple_of(64));
                values.fill(column as f64);
            }
            let values = square.as_mut();
            assert!((0..size).all(|j| (0..size).all(|i| values[(i, j)] == j as f64)));
        }
    }
}
