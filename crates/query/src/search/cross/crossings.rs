//! All crossings of a search, so put together that no piece of surface counts twice.

use std::collections::BTreeMap;

use cloudtouch_geom::Point3;

use crate::cells::Cells;
use crate::cloud::{Edge, Surfel};

use super::crossing::Crossing;
use super::places::{Heard, Places};
use crate::search::wrench::Wrench;

/// Witnesses within so many spacings of one another are at one place: what adds up there does not
/// grow with the area of contact.
pub(in crate::search) const PLACE_SPACINGS: f64 = 3.0;
/// Clearness, in standard deviations, that a crossing seen from one side alone brings without any
/// seen from the other.
pub(in crate::search) const ONE_SIDED: f64 = 0.25;

/// A piece of surface that passes through the other body: an edge, or the disc about a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::search) struct Witness {
    /// Whether it is a piece of A.
    pub is_a: bool,
    /// The two that an edge joins; twice that of a disc.
    pub points: [u32; 2],
}

impl Witness {
    pub(in crate::search) fn edge(is_a: bool, edge: &Edge) -> Self {
        let [p, q] = edge.points;
        Self { is_a, points: [p.min(q), p.max(q)] }
    }

    pub(in crate::search) fn disc(is_a: bool, disc: &Surfel) -> Self {
        Self { is_a, points: [disc.index; 2] }
    }

    /// Whether it says that the surface of A is on both sides of that of B: an edge of A does, and a
    /// disc of B that a mesh passes.
    pub(in crate::search) fn is_of_a(&self) -> bool {
        let is_disc = self.points[0] == self.points[1];
        self.is_a != is_disc
    }
}

/// What one witness saw.
#[derive(Debug, Clone, Copy)]
struct Seen {
    sum: f64,
    clearest: f64,
    best: Crossing,
    sum_by_pose: Wrench,
    clearest_by_pose: Wrench,
}

impl Seen {
    /// An edge passes several discs that overlap: together they are one passage, as clear as the
    /// clearest of them at most.
    fn clearness(&self) -> f64 {
        self.sum.min(self.clearest)
    }

    fn clearness_by_pose(&self) -> Wrench {
        if self.sum < self.clearest { self.sum_by_pose } else { self.clearest_by_pose }
    }
}

/// The crossings found so far.
#[derive(Debug, Default)]
pub(crate) struct Crossings {
    /// Where in `seen` each is.
    witnesses: BTreeMap<Witness, usize>,
    /// In the order in which they were first heard.
    seen: Vec<(Witness, Seen)>,
    /// What each of these says, for most is asked of many times.
    heard: Vec<Heard>,
    /// Where each is.
    cells: Cells,
    /// The witness heard last, until it was looked what there is at its place.
    last: Option<usize>,
    /// What there was at the place looked at last.
    at_last: f64,
}

impl Crossings {
    /// Adds a crossing of a witness that has its middle there, always the same.
    pub(in crate::search) fn add(
        &mut self,
        witness: Witness,
        middle: &Point3,
        crossing: &Crossing,
    ) {
        // What passes may be of A: then it is what is passed that moves.
        let crossing = if witness.is_of_a() { crossing.reversed() } else { *crossing };
        let Crossing { clear, weight, probability, by_pose, spacing, .. } = crossing;
        let reach = PLACE_SPACINGS * spacing;
        let number = *self.witnesses.entry(witness).or_insert_with(|| {
            self.cells.push(middle, reach);
            let (sum, clearest) = (0.0, 0.0);
            let (sum_by_pose, clearest_by_pose) = (Wrench::zeros(), Wrench::zeros());
            let best = crossing;
            self.heard.push(Heard { place: *middle, reach, clearness: [0.0; 2] });
            self.seen.push((witness, Seen { sum, clearest, best, sum_by_pose, clearest_by_pose }));
            self.seen.len() - 1
        });
        let (_, seen) = &mut self.seen[number];
        seen.sum += clear * weight;
        seen.sum_by_pose += by_pose.clear * weight + by_pose.weight * clear;
        if clear > seen.clearest {
            (seen.clearest, seen.clearest_by_pose) = (clear, by_pose.clear);
        }
        if probability > seen.best.probability {
            seen.best = crossing;
        }
        let heard = &mut self.heard[number];
        heard.reach = heard.reach.max(reach);
        heard.clearness[usize::from(witness.is_of_a())] = seen.clearness();
        self.last = Some(number);
    }

    /// The most probable crossing of every witness.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Crossing> {
        self.witnesses.values().map(|&number| &self.seen[number].1.best)
    }

    /// Clearness of all crossings together at the place where it is most. One more never makes it less.
    pub(crate) fn clearness(&self) -> f64 {
        self.clearest_place().map_or(0.0, |(clearness, _)| clearness)
    }

    fn clearest_place(&self) -> Option<(f64, Heard)> {
        let mut clearest: Option<(f64, Heard)> = None;
        // Of equals the first in the order of places, in whatever order they were heard.
        Places::new(&self.heard).visit(|at, [p, q]| {
            let clearness = by_both_sides([p + ONE_SIDED, q + ONE_SIDED]);
            if clearest.is_none_or(|(most, _)| clearness > most) {
                clearest = Some((clearness, *at));
            }
        });
        clearest
    }

    /// What the clearness changes by as the pose does; which crossings are at one place keeps.
    pub(crate) fn clearness_by_pose(&self) -> Wrench {
        let Some((_, at)) = self.clearest_place() else { return Wrench::zeros() };
        let (mut sums, mut by_pose) = ([ONE_SIDED; 2], [Wrench::zeros(); 2]);
        for &number in self.witnesses.values() {
            if at.reaches(&self.heard[number].place) {
                let (witness, seen) = &self.seen[number];
                let side = usize::from(witness.is_of_a());
                sums[side] += seen.clearness();
                by_pose[side] += seen.clearness_by_pose();
            }
        }
        (by_pose[0] * sums[1] + by_pose[1] * sums[0]) / (sums[0] * sums[1]).sqrt()
    }

    /// The same at the place heard of last: no more than that. Most pairs of leaves add no crossing, and
    /// cost nothing here.
    pub(in crate::search) fn last_clearness(&mut self) -> f64 {
        if let Some(last) = self.last.take() {
            self.at_last = self.together(&self.heard[last]);
        }
        self.at_last
    }

    /// What the witnesses within reach of one say together.
    ///
    /// Where two surfaces cross, each is on both sides of the other. Where one ends beside the other, as at
    /// the corner of a table, discs that reach beyond its end are passed by the other, but none of
    /// its own edges passes the other: so the two sides count by their geometric mean.
    fn together(&self, at: &Heard) -> f64 {
        let mut sums = [ONE_SIDED; 2];
        // PERF: of all, bodies that overlap all over would take the square of how many there are.
        self.cells.visit_near(&at.place, at.reach, |number| {
            let other = &self.heard[number];
            if at.reaches(&other.place) {
                sums[0] += other.clearness[0];
                sums[1] += other.clearness[1];
            }
        });
        by_both_sides(sums)
    }
}

/// Clearness given that of either side, each with [`ONE_SIDED`] on top.
pub(in crate::search) fn by_both_sides(sums: [f64; 2]) -> f64 {
    2.0 * ((sums[0] * sums[1]).sqrt() - ONE_SIDED)
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Vector3;
    use proptest::prelude::*;

    use super::*;
    use crate::search::cross::crossing::CrossingByPose;

    fn crossing(x: f64) -> Crossing {
        Crossing {
            clear: 4.0,
            weight: 1.0,
            probability: 0.9,
            place: Point3::new(x, 0.0, 0.0),
            axis: Vector3::z(),
            depth: 0.01,
            std: 0.001,
            spacing: 0.1,
            by_pose: CrossingByPose {
                clear: Wrench::zeros(),
                weight: Wrench::zeros(),
                depth: Wrench::zeros(),
            },
        }
    }

    fn crossings(count: u32, step: f64, sides: [bool; 2]) -> f64 {
        let mut all = Crossings::default();
        for i in 0..count {
            for is_a in [true, false] {
                if sides[usize::from(is_a)] {
                    let witness = Witness { is_a, points: [i, i + 1] };
                    let crossing = crossing(step * f64::from(i));
                    all.add(witness, &crossing.place, &crossing);
                }
            }
        }
        all.clearness()
    }

    #[test]
    fn twice_the_area_of_the_same_contact_is_no_more_evidence() {
        let both = [true, true];
        let (short, long) = (crossings(20, 0.1, both), crossings(200, 0.1, both));
        assert!(short > 20.0 && (long - short).abs() < 1e-9, "{short} {long}");
        // Twice as dense is.
        assert!(crossings(40, 0.05, both) > 1.5 * short);
    }

    #[test]
    fn one_surface_that_ends_beside_the_other_says_little() {
        let (one, both) = (crossings(20, 0.1, [false, true]), crossings(20, 0.1, [true, true]));
        assert!(one > 0.0 && one < 0.3 * both, "{one} {both}");
    }

    #[test]
    fn an_edge_through_several_discs_passes_once() {
        let mut all = Crossings::default();
        let witness = Witness { is_a: true, points: [3, 7] };
        for x in [0.0, 0.01, 0.02] {
            all.add(witness, &Point3::origin(), &crossing(x));
        }
        let mut once = Crossings::default();
        once.add(witness, &Point3::origin(), &crossing(0.0));
        assert_eq!(all.clearness(), once.clearness());
    }

    proptest! {
        /// Few and many, along a line, each through several discs beside its middle.
        #[test]
        fn one_more_crossing_never_takes_from_the_rest_and_their_order_is_all_the_same(
            found in prop::collection::vec(
                (any::<bool>(), 0..100_u32, -0.1..0.1_f64, 0.01..0.2_f64, prop::array::uniform3(0.0..1.0_f64)),
                1..200,
            ),
        ) {
            let add = |all: &mut Crossings, &(is_a, i, aside, spacing, told): &(_, u32, _, _, _)| {
                let middle = Point3::new(0.02 * f64::from(i), 0.0, 0.0);
                let [clear, weight, probability] = told;
                let (clear, known) = (6.0 * clear, crossing(middle.x + aside));
                let crossing = Crossing { clear, weight, probability, spacing, ..known };
                all.add(Witness { is_a, points: [i, i + 1] }, &middle, &crossing);
            };
            let (mut all, mut clearness) = (Crossings::default(), 0.0);
            // Many are summed in another order than few.
            let slack = 1e-12;
            for one in &found {
                add(&mut all, one);
                let more = all.clearness();
                prop_assert!(more >= clearness - slack * (1.0 + clearness), "{more} {clearness}");
                clearness = more;
            }
            let mut turned = Crossings::default();
            found.iter().rev().for_each(|one| add(&mut turned, one));
            prop_assert!((turned.clearness() - clearness).abs() <= slack * (1.0 + clearness));
        }
    }
}
