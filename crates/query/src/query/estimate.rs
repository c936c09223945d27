//! One query on the default path: the evidence, and what the judge makes of it.

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::exact::add_exact;
use crate::judge::{ContactEvidence, probability};
use crate::mesh::Mesh;
use crate::record::{Estimate, Evidence, Places};

use super::places::contacts::{clearance, contacts, nearest};
use super::places::points::add_points;
use super::places::spots::{Spot, Spots, spots};
use super::settings::Detail;
use super::task::Task;
use super::weigh::{Weighed, weigh};

/// Estimates how probable a collision of two bodies is; the probabilities of single points go to
/// `evidence`.
pub(super) fn estimate(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    task: &Task<'_>,
    evidence: &mut Evidence,
) -> Result<Estimate, QueryError> {
    if let (BodyRef::Mesh(a), BodyRef::Mesh(b)) = (a, b) {
        return exact((a, b), a_from_b, task, evidence);
    }
    let weighed = weigh((a, b), a_from_b, task, &mut evidence.stats)?;
    let of_full = (task.settings.detail == Detail::Full).then(|| weighed.spots((a, b), a_from_b));
    Ok(weighed.estimate(of_full.as_ref(), task, evidence))
}

impl Weighed<'_> {
    /// The places where the bodies are nearest to touching, likeliest first.
    pub(super) fn spots<'b>(
        &self,
        bodies: (BodyRef<'b>, BodyRef<'b>),
        a_from_b: &Pose,
    ) -> Spots<'b> {
        spots(bodies, a_from_b, &self.found, self.looked.deepest.as_ref())
    }

    /// The log odds of a collision.
    pub(super) fn log_odds(&self, task: &Task<'_>) -> f64 {
        self.misclassified.log_odds(&task.judge, self.by_geometry)
    }

    /// The estimate; with places, and points to `evidence`, where spots are given.
    pub(super) fn estimate(
        &self,
        spots: Option<&Spots<'_>>,
        task: &Task<'_>,
        evidence: &mut Evidence,
    ) -> Estimate {
        let Self { found, by_geometry, misclassified, .. } = self;
        let settings = task.settings;
        let of = |log_odds| probability(log_odds, settings.prior);
        let revised = |count| of(task.judge.revise(*by_geometry, count));
        let [low, high] = misclassified.bounds.map(revised);
        // What was not looked at may be about as near as what was.
        let low = match self.is_complete && !self.is_extent_open {
            true => low,
            false => {
                let [least, _] = task.judge.with_any_extent(self.by_place);
                low.min(of(task.judge.revise(least, misclassified.bounds[0])))
            }
        };
        let log_odds = self.log_odds(task);
        let probability = of(log_odds);
        // More evidence only raises the odds; what was not looked at may be any. Where the classifier can
        // change nothing, both bounds are the probability but for the rounding of the judge.
        let high = if self.is_complete { high.max(probability) } else { 1.0 };
        let bounds = [low.min(probability), high];
        // Boxes that overlap say nothing of how deep surfaces do: less than nothing bounds nothing.
        let at_least = Some(found.at_least).filter(|least| least.is_finite() && *least > 0.0);
        let places = match spots {
            None => Places { at_least, ..Places::default() },
            Some(spots) => {
                add_points(found, probability, evidence);
                Places {
                    contacts: contacts(spots, probability, settings.max_contacts),
                    clearance: self
                        .nearest_spot(spots, probability)
                        .filter(|spot| !spots.are_nearer_than(spot, &task.clock))
                        .map(clearance),
                    at_least,
                }
            }
        };
        let misclassified = misclassified.value;
        Estimate {
            probability,
            bounds,
            evidence: Some(ContactEvidence { misclassified, ..self.of_geometry }),
            log_likelihood_ratio: Some(log_odds),
            places: Some(places),
            is_too_late: self.is_too_late,
        }
    }

    /// The place that tells the clearance, where nothing nearer was left out.
    pub(super) fn nearest_spot<'s>(
        &self,
        spots: &'s Spots<'_>,
        probability: f64,
    ) -> Option<&'s Spot> {
        nearest(spots, probability).filter(|_| self.found.is_complete || probability > 0.5)
    }
}

/// Two exact surfaces: a yes or no, or either where the time was over before.
pub(super) fn exact(
    (a, b): (&Mesh, &Mesh),
    a_from_b: &Pose,
    task: &Task<'_>,
    evidence: &mut Evidence,
) -> Result<Estimate, QueryError> {
    let is_too_late = task.clock.is_over();
    if !is_too_late {
        add_exact((a, b), a_from_b, task.settings.detail == Detail::Full, evidence)?;
    }
    let probability = evidence.largest();
    let bounds = [probability, if is_too_late { 1.0 } else { probability }];
    Ok(Estimate {
        probability,
        bounds,
        evidence: None,
        log_likelihood_ratio: None,
        places: None,
        is_too_late,
    })
}
