//! All crossings of a search, so put together that no piece of surface counts twice.

use std::collections::BTreeMap;

use crate::cloud::{Edge, Surfel};

use super::crossing::Crossing;

/// A piece of surface that passes through the other body: an edge, or the disc about a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Witness {
    is_a: bool,
    points: [u32; 2],
}

impl Witness {
    pub(super) fn edge(is_a: bool, edge: &Edge) -> Self {
        let [p, q] = edge.points;
        Self { is_a, points: [p.min(q), p.max(q)] }
    }

    pub(super) fn disc(is_a: bool, disc: &Surfel) -> Self {
        Self { is_a, points: [disc.index; 2] }
    }
}

/// What one witness saw.
#[derive(Debug, Clone, Copy)]
struct Seen {
    sum: f64,
    clearest: f64,
    best: Crossing,
}

impl Seen {
    /// An edge passes several discs that overlap: together they are one passage, as clear as the
    /// clearest of them at most.
    fn clearness(&self) -> f64 {
        self.sum.min(self.clearest)
    }
}

/// The crossings found so far.
#[derive(Debug, Default)]
pub(super) struct Crossings {
    witnesses: BTreeMap<Witness, Seen>,
    total: f64,
}

impl Crossings {
    pub(super) fn add(&mut self, witness: Witness, crossing: &Crossing) {
        let Crossing { clear, weight, probability, .. } = *crossing;
        let seen = self.witnesses.entry(witness);
        let seen = seen.or_insert(Seen { sum: 0.0, clearest: 0.0, best: *crossing });
        let before = seen.clearness();
        seen.sum += clear * weight;
        seen.clearest = seen.clearest.max(clear);
        if probability > seen.best.probability {
            seen.best = *crossing;
        }
        self.total += seen.clearness() - before;
    }

    /// Clearness of all crossings together; never less by one more.
    pub(super) fn total(&self) -> f64 {
        self.total
    }

    /// The most probable crossing of every witness with its clearness.
    pub(super) fn iter(&self) -> impl Iterator<Item = (&Crossing, f64)> {
        self.witnesses.values().map(|seen| (&seen.best, seen.clearness()))
    }
}
