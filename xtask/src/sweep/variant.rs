//! The variants of the families: which scene belongs to a number.

use cloudtouch_geom::seed;
use cloudtouch_testkit::family::Family;

use super::SEED;

/// Variants of each family that the sweep asks about.
pub(crate) const COUNT: u64 = 4;

/// The seed of a variant's scene.
pub(crate) fn seed_of(family: Family, variant: u64) -> u64 {
    seed::derive(SEED, family as u64, variant)
}
