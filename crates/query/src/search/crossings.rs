//! All crossings of a search, so put together that no piece of surface counts twice.

use std::collections::BTreeMap;

use cloudtouch_geom::Point3;

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
#[derive(Debug, Clone)]
struct Seen {
    all: Vec<([f64; 2], [f64; 2], f64, f64)>,
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

/// Crossings within so many spacings of one another are at one place: what adds up there does not
/// grow with the area of contact.
const PLACE_SPACINGS: f64 = 3.0;

/// The crossings found so far.
#[derive(Debug, Default)]
pub(crate) struct Crossings {
    witnesses: BTreeMap<Witness, Seen>,
    /// The witness heard last.
    last: Option<Witness>,
}

impl Crossings {
    pub(super) fn add(&mut self, witness: Witness, crossing: &Crossing) {
        let Crossing { clear, weight, probability, .. } = *crossing;
        let seen = self.witnesses.entry(witness);
        let seen = seen.or_insert(Seen { all: Vec::new(), sum: 0.0, clearest: 0.0, best: *crossing });
        seen.all.push((crossing.heights, crossing.stds, weight, crossing.spacing));
        seen.sum += clear * weight;
        seen.clearest = seen.clearest.max(clear);
        if probability > seen.best.probability {
            seen.best = *crossing;
        }
        self.last = Some(witness);
    }

    /// The most probable crossing of every witness with its clearness.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&Crossing, f64)> {
        self.witnesses.values().map(|seen| (&seen.best, seen.clearness()))
    }

    /// Clearness of all crossings together at the place where it is most.
    pub(crate) fn clearness(&self) -> f64 {
        let mut all: Vec<(Point3, f64, f64)> =
            self.iter().map(|(c, s)| (c.place, PLACE_SPACINGS * c.spacing, s)).collect();
        all.sort_by(|p, q| p.0.x.total_cmp(&q.0.x));
        let around = |(place, reach, _): &(Point3, f64, f64)| -> f64 {
            let from = all.partition_point(|other| other.0.x < place.x - reach);
            all[from..]
                .iter()
                .take_while(|other| other.0.x <= place.x + reach)
                .filter(|other| (other.0 - place).norm_squared() <= reach * reach)
                .map(|other| other.2)
                .sum()
        };
        all.iter().map(around).fold(0.0, f64::max)
    }

    /// The same at the place heard of last: no more than that.
    pub(super) fn last_clearness(&self) -> f64 {
        let Some(last) = self.last.and_then(|witness| self.witnesses.get(&witness)) else {
            return 0.0;
        };
        let (place, reach) = (last.best.place, PLACE_SPACINGS * last.best.spacing);
        let is_there = |crossing: &Crossing| (crossing.place - place).norm() <= reach;
        self.iter().filter(|(crossing, _)| is_there(crossing)).map(|(_, s)| s).sum()
    }
}

impl Crossings {
    /// X.
    pub(crate) fn variant(&self, e: f64, r: f64) -> f64 {
        let mut all: Vec<(Point3, f64, f64)> = self
            .witnesses
            .values()
            .map(|seen| {
                let mut sum = 0.0;
                let mut clearest = 0.0_f64;
                for (heights, stds, weight, spacing) in &seen.all {
                    let clear = (0..2)
                        .map(|k| heights[k].abs() / (stds[k].powi(2) + (e * spacing).powi(2)).sqrt().max(1e-300))
                        .fold(6.0, f64::min);
                    sum += clear * weight;
                    clearest = clearest.max(clear);
                }
                (seen.best.place, r * seen.best.spacing, sum.min(clearest))
            })
            .collect();
        all.sort_by(|p, q| p.0.x.total_cmp(&q.0.x));
        let around = |(place, reach, _): &(Point3, f64, f64)| -> f64 {
            let from = all.partition_point(|other| other.0.x < place.x - reach);
            all[from..]
                .iter()
                .take_while(|other| other.0.x <= place.x + reach)
                .filter(|other| (other.0 - place).norm_squared() <= reach * reach)
                .map(|other| other.2)
                .sum()
        };
        all.iter().map(around).fold(0.0, f64::max)
    }
}
