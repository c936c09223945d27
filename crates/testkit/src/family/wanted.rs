//! The strata of poses, and how they follow one another.

use cloudtouch_geom::seed;

/// What a pose is drawn for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Wanted {
    NearFree,
    Free,
    NearDeep,
    Deep,
}

impl Wanted {
    /// The stratum of the pose at a place in the sequence that belongs to a seed.
    ///
    /// Each four in a row are of the four strata, and each two, from the first on, a free one and
    /// one in collision, one near and one not: so are the shares whole at every even length.
    pub(super) fn of(index: u64, seed: u64) -> Self {
        let coin = |of: u64| seed::derive(seed, 2, of) & 1 == 1;
        let (four, pair) = (index / 4, index / 2);
        // The second pair has what the first lacks; each may come the other way around.
        let free_is_near = coin(4 * four) ^ (pair % 2 == 1);
        let is_free = coin(4 * four + 1 + pair % 2) ^ (index % 2 == 1);
        match (is_free, is_free == free_is_near) {
            (true, true) => Self::NearFree,
            (true, false) => Self::Free,
            (false, true) => Self::NearDeep,
            (false, false) => Self::Deep,
        }
    }

    pub(super) fn is_near(self) -> bool {
        matches!(self, Self::NearFree | Self::NearDeep)
    }

    pub(super) fn is_free(self) -> bool {
        matches!(self, Self::NearFree | Self::Free)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_exact_at_every_even_count_and_within_one_pose_at_any() {
        for seed in 0..50 {
            for count in 1..40 {
                let strata: Vec<Wanted> = (0..count).map(|i| Wanted::of(i, seed)).collect();
                let share = |is: fn(Wanted) -> bool| strata.iter().filter(|w| is(**w)).count();
                let half = strata.len() / 2;
                for number in [share(Wanted::is_free), share(Wanted::is_near)] {
                    assert!((half..=half + strata.len() % 2).contains(&number));
                }
                for stratum in [Wanted::NearFree, Wanted::Free, Wanted::NearDeep, Wanted::Deep] {
                    let number = strata.iter().filter(|w| **w == stratum).count();
                    assert!((count as usize / 4..=(count as usize).div_ceil(4)).contains(&number));
                }
            }
        }
    }

    #[test]
    fn the_place_in_the_sequence_does_not_give_the_answer_away() {
        for index in 0..4 {
            let free = (0..400).filter(|&seed| Wanted::of(index, seed).is_free()).count();
            assert!((150..250).contains(&free), "{free} of 400 are free at {index}");
        }
    }
}
