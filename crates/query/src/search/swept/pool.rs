//! All passages that may be, put together as `search/cross/crossings.rs` does with crossings that are.

use std::collections::BTreeMap;

use cloudtouch_geom::Point3;

use super::passage::Passage;
use super::track::Track;
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
        for other in &self.heard {
            let reach = at.reach + at.by + other.by;
            if (other.place - at.place).norm_squared() <= reach * reach {
                sums[usize::from(other.is_of_a)] += other.sum.min(other.clearest);
            }
        }
        by_both_sides(sums)
    }
}
