//! Numbers in groups that the compiler makes vector instructions of.
//!
//! Groups are of one size on every machine and no operation is fused with another, so that results
//! do not depend on which instructions the processor has.

use std::ops::{Add, AddAssign, Div, Mul, Sub};

/// Numbers in a group: a register of AVX-512, two of AVX2.
pub(crate) const WIDTH: usize = 8;

/// A group of numbers; operations are element by element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lane(pub(crate) [f64; WIDTH]);

impl Lane {
    pub(crate) const ZERO: Self = Self([0.0; WIDTH]);

    #[inline(always)]
    pub(crate) fn splat(value: f64) -> Self {
        Self([value; WIDTH])
    }

    #[inline(always)]
    pub(crate) fn from_fn(mut of: impl FnMut(usize) -> f64) -> Self {
        let mut result = [0.0; WIDTH];
        for (k, value) in result.iter_mut().enumerate() {
            *value = of(k);
        }
        Self(result)
    }

    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        Self::from_fn(|k| self.0[k].sqrt())
    }
}

impl Add for Lane {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::from_fn(|k| self.0[k] + other.0[k])
    }
}

impl AddAssign for Lane {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Lane {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::from_fn(|k| self.0[k] - other.0[k])
    }
}

impl Mul for Lane {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::from_fn(|k| self.0[k] * other.0[k])
    }
}

impl Div for Lane {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self::from_fn(|k| self.0[k] / other.0[k])
    }
}

/// One number for each sample, in lanes; what the last lane has beyond them is 0.
#[derive(Debug, Clone, Default)]
pub(crate) struct Lanes(Vec<Lane>);

impl Lanes {
    pub(crate) fn new(values: impl Iterator<Item = f64>) -> Self {
        let mut lanes = Vec::new();
        for (k, value) in values.enumerate() {
            if k % WIDTH == 0 {
                lanes.push(Lane::ZERO);
            }
            lanes[k / WIDTH].0[k % WIDTH] = value;
        }
        Self(lanes)
    }

    /// Zeros for so many samples.
    pub(crate) fn reset(&mut self, samples: usize) {
        self.0.clear();
        self.0.resize(samples.div_ceil(WIDTH), Lane::ZERO);
    }

    #[inline]
    pub(crate) fn at(&self, sample: usize) -> f64 {
        self.0[sample / WIDTH].0[sample % WIDTH]
    }

    #[inline]
    pub(crate) fn put(&mut self, sample: usize, value: f64) {
        self.0[sample / WIDTH].0[sample % WIDTH] = value;
    }

    #[inline(always)]
    pub(crate) fn lanes(&self) -> &[Lane] {
        &self.0
    }

    #[inline(always)]
    pub(crate) fn lanes_mut(&mut self) -> &mut [Lane] {
        &mut self.0
    }
}

/// The largest of many numbers and where it is: the first of equals, none that is not a number.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Largest {
    value: Lane,
    /// Which group each is of, as a number that is chosen as the values are; [`NOTHING`] where none is.
    lane: Lane,
}

/// Less than any sample, as a sample too.
const NOTHING: f64 = -1.0;

impl Largest {
    /// Nothing is found that is not larger than this.
    #[inline(always)]
    pub(crate) fn above(least: f64) -> Self {
        Self { value: Lane::splat(least), lane: Lane::splat(NOTHING) }
    }

    #[inline(always)]
    pub(crate) fn see(&mut self, lane: usize, values: Lane) {
        let at = f64::from(lane as u32);
        for k in 0..WIDTH {
            let larger = values.0[k] > self.value.0[k];
            self.value.0[k] = if larger { values.0[k] } else { self.value.0[k] };
            self.lane.0[k] = if larger { at } else { self.lane.0[k] };
        }
    }

    /// Its sample and its value.
    #[inline(always)]
    pub(crate) fn found(&self) -> Option<(usize, f64)> {
        let most = folded(self.value, |a, b| if b > a { b } else { a });
        // Where anything was found it is larger than what nothing was found above.
        let first = folded(
            Lane::from_fn(|k| {
                let sample = self.lane.0[k] * WIDTH as f64 + k as f64;
                if self.value.0[k] == most { sample } else { f64::INFINITY }
            }),
            |a, b| if b < a { b } else { a },
        );
        (first >= 0.0).then_some((first as usize, most))
    }
}

/// All of a group put together, by halves.
#[inline(always)]
fn folded(lane: Lane, of: impl Fn(f64, f64) -> f64) -> f64 {
    let mut values = lane.0;
    let mut half = WIDTH / 2;
    while half > 0 {
        for k in 0..half {
            values[k] = of(values[k], values[k + half]);
        }
        half /= 2;
    }
    values[0]
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_largest_is_the_first_of_the_largest(
            values in prop::collection::vec(prop::sample::select(vec![-2.0, -1.0, 0.5, 1.0, f64::NAN]), 1..40),
        ) {
            let lanes = Lanes::new(values.iter().copied());
            let mut largest = Largest::above(-1.5);
            for (k, lane) in lanes.lanes().iter().enumerate() {
                let beyond = |j: usize| k * WIDTH + j >= values.len();
                largest.see(k, Lane::from_fn(|j| if beyond(j) { -3.0 } else { lane.0[j] }));
            }
            let mut expected: Option<(usize, f64)> = None;
            for (k, &value) in values.iter().enumerate() {
                if value > -1.5 && expected.is_none_or(|(_, most)| value > most) {
                    expected = Some((k, value));
                }
            }
            prop_assert_eq!(largest.found(), expected);
        }
    }
}
