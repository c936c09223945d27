//! Reproducible randomness: seeds are passed in, and derived for each use.
//!
//! A stream that depends on *what* it is for (a pair of tree nodes, say) and never on *when* it is
//! asked for gives the same bits with one thread or many.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A seed for the use named by `first` and `second`, derived from a parent seed.
///
/// Distinct inputs give unrelated seeds (two rounds of the SplitMix64 finaliser).
pub fn derive(seed: u64, first: u64, second: u64) -> u64 {
    mix(mix(seed ^ mix(first)).wrapping_add(mix(second ^ 0x9e37_79b9_7f4a_7c15)))
}

/// The portable generator all of cloudtouch uses (ChaCha, 8 rounds), seeded.
pub fn generator(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// One number in [0, 1), the first of the stream of `seed`.
pub fn unit(seed: u64) -> f64 {
    // 53 random bits: every multiple of 2⁻⁵³ is equally likely.
    (generator(seed).next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
}

fn mix(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derived_seeds_differ_and_are_stable() {
        let seeds = [derive(0, 0, 0), derive(0, 0, 1), derive(0, 1, 0), derive(1, 0, 0)];
        for i in 0..4 {
            for j in 0..i {
                assert_ne!(seeds[i], seeds[j]);
            }
        }
        assert_eq!(derive(7, 3, 5), derive(7, 3, 5));
    }

    #[test]
    fn unit_is_uniform_enough() {
        let n = 20_000;
        let mean = (0..n).map(|i| unit(derive(42, i, 0))).sum::<f64>() / n as f64;
        // Six standard errors of the mean of n uniforms.
        assert!((mean - 0.5).abs() < 6.0 / (12.0 * n as f64).sqrt(), "mean {mean}");
    }
}
