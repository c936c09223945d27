//! All passages that may be, put together as `search/cross/crossings.rs` does with crossings that are.

use std::collections::BTreeMap;

use cloudtouch_geom::Point3;

use super::passage::Passage;
use super::track::Track;
use crate::cells::Cells;
use crate::search::cross::crossings::{ONE_SIDED, PLACE_SPACINGS, Witness, by_both_sides};

/// What one witness may see at most.
#[derive(Debug, Clone, Copy)]
struct MaySee {
    /// As [`Witness::is_of_a`].
    is_of_a: bool,
    sum: f64,
    clearest: f64,
    /// Where its middle is, and how far that gets from there, m: those of A keep still.
    place: Point3,
    by: f64,
    /// What counts as one place with it reaches so far, m.
    reach: f64,
}

/// The passages heard of so far.
#[derive(Debug, Default)]
pub(super) struct Passages {
    heard: Vec<MaySee>,
    /// Where each of the witnesses is among these.
    indices: BTreeMap<Witness, usize>,
    /// Where each is.
    cells: Cells,
    /// How far the middle of any of them gets, m.
    farthest: f64,
    /// Where the witness heard last is, until it was looked what there may be at its place.
    last: Option<usize>,
    /// What there may be at the place looked at last.
    at_last: f64,
}

impl Passages {
    /// Adds one of the passages of a witness whose middle gets so far.
    pub(super) fn add(&mut self, witness: Witness, middle: &Track, passage: &Passage) {
        let Passage { clear, weight, spacing } = *passage;
        let index = *self.indices.entry(witness).or_insert(self.heard.len());
        if index == self.heard.len() {
            let (is_of_a, place) = (witness.is_of_a(), middle.place);
            let by = if witness.is_a { 0.0 } else { middle.in_any_direction() };
            let (sum, clearest, reach) = (0.0, 0.0, 0.0);
            self.cells.push(&place, PLACE_SPACINGS * spacing);
            self.farthest = self.farthest.max(by);
            self.heard.push(MaySee { is_of_a, sum, clearest, place, by, reach });
        }
        let seen = &mut self.heard[index];
        seen.sum += clear * weight;
        seen.clearest = seen.clearest.max(clear);
        seen.reach = seen.reach.max(PLACE_SPACINGS * spacing);
        self.last = Some(index);
    }

    /// No place on the way sees more than this.
    pub(super) fn clearness(&self) -> f64 {
        self.heard.iter().map(|at| self.around(at)).fold(0.0, f64::max)
    }

    /// The same at the place heard of last: most pairs of leaves add nothing, and cost nothing here.
    pub(super) fn last_clearness(&mut self) -> f64 {
        if let Some(at) = self.last.take().map(|last| &self.heard[last]) {
            self.at_last = self.around(at);
        }
        self.at_last
    }

    /// What all witnesses say that may at some time be within reach of one.
    fn around(&self, at: &MaySee) -> f64 {
        let mut sums = [ONE_SIDED; 2];
        // PERF: of all, faces that come down on one another would take the square of how many there are.
        self.cells.visit_near(&at.place, at.reach + at.by + self.farthest, |number| {
            let other = &self.heard[number];
            let reach = at.reach + at.by + other.by;
            if (other.place - at.place).norm_squared() <= reach * reach {
                sums[usize::from(other.is_of_a)] += other.sum.min(other.clearest);
            }
        });
        by_both_sides(sums)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Vector3;
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// By looking at all others for each; few and many, those of B getting nowhere or through half of them.
        #[test]
        fn those_at_one_place_are_found_among_all(
            found in prop::collection::vec(
                (any::<bool>(), 0..200_u32, 0.01..0.1_f64, 0.0..1.0_f64, 0.0..1.0_f64),
                1..300,
            ),
            way in prop_oneof![Just(0.0), 0.0..2.0_f64],
        ) {
            let mut all = Passages::default();
            for &(is_a, i, spacing, clear, share) in &found {
                let place = Point3::new(0.02 * f64::from(i), 0.1 * f64::from(i % 7), 0.0);
                let middle = Track { place, way: Vector3::new(0.0, way * share, 0.0), beside: 0.0 };
                let passage = Passage { clear, weight: 1.0, spacing };
                all.add(Witness { is_a, points: [i, i + 1] }, &middle, &passage);
            }
            let around = |at: &MaySee| {
                let mut sums = [ONE_SIDED; 2];
                for other in &all.heard {
                    if (other.place - at.place).norm() <= at.reach + at.by + other.by {
                        sums[usize::from(other.is_of_a)] += other.sum.min(other.clearest);
                    }
                }
                by_both_sides(sums)
            };
            let expected = all.heard.iter().map(around).fold(0.0, f64::max);
            let clearness = all.clearness();
            prop_assert!((clearness - expected).abs() <= 1e-12 * (1.0 + expected), "{clearness} {expected}");
        }
    }
}
