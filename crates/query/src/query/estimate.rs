//! One query on the default path: the search, the classifier where that leaves doubt, the judge.

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::exact::add_exact;
use crate::judge::{ContactEvidence, MOST_DEVIATIONS, probability};
use crate::mesh::Mesh;
use crate::record::{Estimate, Evidence, Places};
use crate::search::{Found, Inside, look_inside, search};

use super::classify::{Misclassified, ask_classifier};
use super::contacts::{clearance, contacts};
use super::points::add_points;
use super::settings::Detail;
use super::spots::spots;
use super::task::Task;

/// Estimates how probable a collision of two bodies is; the probabilities of single points go to
/// `evidence`.
pub(super) fn estimate(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    task: &Task<'_>,
    evidence: &mut Evidence,
) -> Result<Estimate, QueryError> {
    if let (BodyRef::Mesh(a), BodyRef::Mesh(b)) = (a, b) {
        return exact((a, b), a_from_b, evidence);
    }
    let (settings, judge) = (task.settings, &task.settings.judge);
    let stats = &mut evidence.stats;
    let looked = look_inside((a, b), a_from_b, &task.clock);
    stats.nodes_visited += looked.nodes_visited;
    stats.leaves_prepared += looked.leaves_prepared;
    let depth = looked.deepest.map_or(0.0, |inside| inside.deviations);
    let of = |log_odds| probability(log_odds, settings.prior);
    let is_enough = |deviations: f64, clearness: f64| {
        let log_odds = judge.log_odds_by_geometry(deviations - depth, clearness.ln_1p());
        // More evidence only raises the odds; what a classifier could take off them is taken off.
        let is_decided = || of(judge.revise(log_odds, 0.0)) > settings.accept;
        of(log_odds) > settings.stop_above
            || settings.detail == Detail::Verdict && is_decided()
            || task.clock.is_over()
    };
    let found = search((a, b), a_from_b, is_enough, stats)?;
    let deviations = (found.deviations - depth).max(-MOST_DEVIATIONS);
    let crossing = found.crossings.clearness().ln_1p();
    let of_geometry = ContactEvidence { deviations, crossing, misclassified: None };
    let by_geometry = judge.log_odds_by_geometry(deviations, crossing);
    let is_complete = found.is_complete && !looked.is_cut_short;

    // Whatever a classifier says, the verdict is the same.
    let is_settled = || {
        of(judge.revise(by_geometry, f64::INFINITY)) < settings.reject
            || of(judge.revise(by_geometry, 0.0)) > settings.accept
    };
    let is_open = judge.is_open(by_geometry);
    let is_wanted = is_open && !(settings.detail == Detail::Verdict && is_settled());
    let misclassified = if is_complete && is_wanted {
        ask_classifier((a, b), a_from_b, &found, by_geometry, task, &mut evidence.stats)?
    } else {
        Misclassified::NOT_ASKED
    };
    let [low, high] = misclassified.bounds.map(|count| of(judge.revise(by_geometry, count)));
    let log_odds = misclassified.log_odds(judge, by_geometry);
    // More evidence only raises the odds; what was not looked at may be any.
    let bounds = [low, if is_complete { high } else { 1.0 }];

    let probability = of(log_odds);
    let is_full = settings.detail == Detail::Full;
    if is_full {
        add_points(&found, probability, evidence);
    }
    let places = || places((a, b), &found, looked.deepest.as_ref(), probability, task);
    let at_least = Some(found.at_least).filter(|least| least.is_finite());
    let without = || Places { at_least, ..Places::default() };
    Ok(Estimate {
        probability,
        bounds,
        evidence: Some(ContactEvidence { misclassified: misclassified.value, ..of_geometry }),
        log_likelihood_ratio: Some(log_odds),
        places: Some(if is_full { places() } else { without() }),
    })
}

fn places(
    bodies: (BodyRef<'_>, BodyRef<'_>),
    found: &Found<'_>,
    inside: Option<&Inside>,
    probability: f64,
    task: &Task<'_>,
) -> Places {
    let spots = spots(bodies, found, inside);
    Places {
        contacts: contacts(&spots, probability, task.settings.max_contacts),
        clearance: clearance(&spots, probability)
            .filter(|_| found.is_complete || probability > 0.5),
        at_least: Some(found.at_least).filter(|least| least.is_finite()),
    }
}

/// Two exact surfaces: a yes or no.
fn exact(
    (a, b): (&Mesh, &Mesh),
    a_from_b: &Pose,
    evidence: &mut Evidence,
) -> Result<Estimate, QueryError> {
    add_exact((a, b), a_from_b, evidence)?;
    let probability = evidence.largest();
    let bounds = [probability; 2];
    Ok(Estimate { probability, bounds, evidence: None, log_likelihood_ratio: None, places: None })
}
