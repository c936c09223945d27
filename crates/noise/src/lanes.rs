//! Four numbers at a time, by the vector instructions that the machine has: the same bits with any of
//! them, for what is added to what does not depend on them.

use std::ops::{Add, AddAssign, Mul, Sub};

use pulp::{Scalar256b, Simd, WithSimd, cast, f64x4};

/// How many numbers go together.
pub(crate) const WIDTH: usize = 4;
/// As they are stored.
pub(crate) type Stored = [f64; WIDTH];

/// Instructions for four numbers at a time.
pub(crate) trait Machine: Simd<f64s = f64x4> {}

impl<S: Simd<f64s = f64x4>> Machine for S {}

/// What can be done with any of them. Only what is inlined into it gets these instructions, which
/// closures given to the standard library do not.
pub(crate) trait Kernel {
    type Output;

    fn run<S: Machine>(self, machine: S) -> Self::Output;
}

/// Runs it with the best instructions there are.
pub(crate) fn run<K: Kernel>(kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(machine) = pulp::x86::V3::try_new() {
        return Simd::vectorize(machine, On { machine, kernel });
    }
    let machine = Scalar256b;
    Simd::vectorize(machine, On { machine, kernel })
}

/// A kernel with the machine it runs on, whose width is known.
struct On<S, K> {
    machine: S,
    kernel: K,
}

impl<S: Machine, K: Kernel> WithSimd for On<S, K> {
    type Output = K::Output;

    #[inline(always)]
    fn with_simd<Same: Simd>(self, _: Same) -> K::Output {
        self.kernel.run(self.machine)
    }
}

/// Numbers of neighbours that are next to one another in their order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lanes<S>(S, f64x4);

impl<S: Machine> Lanes<S> {
    #[inline(always)]
    pub(crate) fn load(machine: S, values: Stored) -> Self {
        Self(machine, cast(values))
    }

    #[inline(always)]
    pub(crate) fn splat(machine: S, value: f64) -> Self {
        Self(machine, machine.splat_f64s(value))
    }

    #[inline(always)]
    pub(crate) fn zero(machine: S) -> Self {
        Self::splat(machine, 0.0)
    }

    #[inline(always)]
    pub(crate) fn stored(self) -> Stored {
        cast(self.1)
    }

    /// Zero for what is negative.
    #[inline(always)]
    pub(crate) fn not_negative(self) -> Self {
        Self(self.0, self.0.max_f64s(self.1, self.0.splat_f64s(0.0)))
    }

    /// One number for what is less.
    #[inline(always)]
    pub(crate) fn at_least(self, least: f64) -> Self {
        Self(self.0, self.0.max_f64s(self.1, self.0.splat_f64s(least)))
    }

    /// One over each.
    #[inline(always)]
    pub(crate) fn inverse(self) -> Self {
        Self(self.0, self.0.div_f64s(self.0.splat_f64s(1.0), self.1))
    }

    /// The root of each.
    #[inline(always)]
    pub(crate) fn sqrt(self) -> Self {
        Self(self.0, self.0.sqrt_f64s(self.1))
    }

    /// `self` · `times` + `plus`, rounded once or twice, as the machine does it: not the same bits with any of them.
    #[inline(always)]
    pub(crate) fn times_plus(self, times: Self, plus: Self) -> Self {
        Self(self.0, self.0.mul_add_e_f64s(self.1, times.1, plus.1))
    }

    #[inline(always)]
    pub(crate) fn sum(self) -> f64 {
        let [a, b, c, d] = self.stored();
        (a + c) + (b + d)
    }
}

impl<S: Machine> Add for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(self.0, self.0.add_f64s(self.1, other.1))
    }
}

impl<S: Machine> AddAssign for Lanes<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Machine> Sub for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(self.0, self.0.sub_f64s(self.1, other.1))
    }
}

impl<S: Machine> Mul for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(self.0, self.0.mul_f64s(self.1, other.1))
    }
}

impl<S: Machine> Mul<f64> for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self * Self::splat(self.0, other)
    }
}
