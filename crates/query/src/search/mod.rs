//! Two clouds: geometry first, the classifier where geometry leaves doubt,
//! and a probability fitted to scenes whose truth is known.
//!
//! The search gathers how far apart the surfaces are in standard deviations and how clearly they
//! cross; in doubt a robust classifier is trained on up to three contact patches. See
//! docs/decisions for what this replaced and why.

mod crossing;
mod crossings;
mod facet;
mod inside;
mod leaf;
mod meeting;
mod nearest;
mod patches;
mod places;
mod search;
mod through_mesh;

use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::classifier::{PairAnswer, by_kernel};
use crate::cloud::Cloud;
use crate::error::QueryError;
use crate::recalibration::{ContactEvidence, MOST_CERTAIN, MOST_DEVIATIONS, Recalibration};
use crate::record::{Estimate, Evidence, add_pair};
use crate::shape::Shape;

use super::settings::QuerySettings;
use super::task::Task;

use patches::patches;
use places::{add_crossing, add_finding, add_leaves};
use search::{Found, search};

/// Estimates how probable a collision of two clouds is; points, contacts and clearance go to
/// `evidence`.
pub(super) fn estimate(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    task: &Task<'_>,
    evidence: &mut Evidence,
) -> Result<Estimate, QueryError> {
    let settings = task.settings;
    let recalibration = &settings.recalibration;
    let is_enough = |deviations: f64, crossing: f64| {
        let probability = recalibration.probability_by_geometry(deviations, crossing.ln_1p());
        probability > settings.stop_above || is_final(settings, probability) || task.clock.is_over()
    };
    let stats = &mut evidence.stats;
    let found = search((a, b), a_from_b, &task.traversal, is_enough, stats)?;
    let of_geometry = ContactEvidence {
        deviations: found.deviations,
        crossing: found.crossings.total().ln_1p(),
        misclassified: None,
        features: features(&found, inside::inside((a, b), a_from_b)),
    };
    let estimate = by_geometry(settings, &found, of_geometry);
    let [lowest, highest] = settings.doubt;
    let is_doubtful = (lowest..=highest).contains(&estimate.probability) && found.is_complete;
    let answer =
        if is_doubtful { ask_classifier((a, b), a_from_b, &found, task, evidence)? } else { None };
    if let Some(misclassified) = answer {
        return Ok(by_all(recalibration, of_geometry, &misclassified));
    }
    for finding in &found.findings {
        add_finding(finding, evidence);
    }
    for (crossing, _) in found.crossings.iter() {
        add_crossing(crossing, evidence);
    }
    add_leaves(&found, evidence);
    Ok(estimate)
}

/// The answer of geometry alone. Surfaces too far apart to tell by how much have no more than the
/// bound they were culled by.
///
/// More evidence only raises either model; so after an early stop the answer lies above the lesser
/// of what both say now, or above that of geometry where the classifier would not be asked.
fn by_geometry(settings: &QuerySettings, found: &Found<'_>, evidence: ContactEvidence) -> Estimate {
    let ContactEvidence { deviations, crossing, .. } = evidence;
    let by_geometry = settings.recalibration.probability_by_geometry(deviations, crossing);
    let probability = if found.is_complete && deviations >= MOST_DEVIATIONS && crossing == 0.0 {
        by_geometry
    } else {
        by_geometry
    };
    let bounds = if found.is_complete || is_final(settings, probability) {
        [probability; 2]
    } else if probability > settings.doubt[1] {
        [probability, 1.0]
    } else {
        [probability.min(settings.recalibration.probability_by_all(deviations, crossing, 0.0)), 1.0]
    };
    Estimate { probability, bounds, evidence: Some(evidence) }
}

/// Whether no further evidence of geometry can change the answer.
fn is_final(settings: &QuerySettings, by_geometry: f64) -> bool {
    by_geometry >= MOST_CERTAIN && settings.doubt[1] < MOST_CERTAIN
}

fn by_all(
    recalibration: &Recalibration,
    of_geometry: ContactEvidence,
    misclassified: &Misclassified,
) -> Estimate {
    let of = |count| {
        recalibration.probability_by_all(of_geometry.deviations, of_geometry.crossing, count)
    };
    let evidence = ContactEvidence { misclassified: Some(misclassified.value), ..of_geometry };
    Estimate {
        probability: of(misclassified.value),
        bounds: misclassified.bounds.map(of),
        evidence: Some(evidence),
    }
}

/// ΣP, largest over the patches, and between what bounds it is known.
#[derive(Debug, Clone, Copy, Default)]
struct Misclassified {
    value: f64,
    bounds: [f64; 2],
}

impl Misclassified {
    fn known(value: f64) -> Self {
        Self { value, bounds: [value; 2] }
    }

    /// Of a patch of so many points that no solver could decide.
    fn unknown(points: usize) -> Self {
        let points = points as f64;
        Self { value: 0.5 * points, bounds: [0.0, points] }
    }

    fn or_more(self, other: Self) -> Self {
        let [[low, high], [other_low, other_high]] = [self.bounds, other.bounds];
        Self {
            value: self.value.max(other.value),
            bounds: [low.max(other_low), high.max(other_high)],
        }
    }
}

/// What the classifier says of the patches; `None` where the noise is as large as all of them, so
/// that geometry has to do.
fn ask_classifier(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    found: &Found<'_>,
    task: &Task<'_>,
    evidence: &mut Evidence,
) -> Result<Option<Misclassified>, QueryError> {
    let settings = task.settings;
    let (deviations, crossing) = (found.deviations, found.crossings.total().ln_1p());
    let mut all: Option<Misclassified> = None;
    for points in patches((a, b), a_from_b, found, settings.max_mesh_parts)? {
        let count = points.a.len() + points.b.len();
        if task.clock.is_over() {
            // Of the patches that are left only bounds are known.
            let left = Misclassified { value: 0.0, ..Misclassified::unknown(count) };
            all = all.map(|known| known.or_more(left)).or(Some(Misclassified::unknown(count)));
            continue;
        }
        let answer = by_kernel(&points, &task.classifier, &task.clock, &mut evidence.stats);
        let of_patch = match &answer {
            PairAnswer::Separated { a, b, .. } => Misclassified::known(a.iter().chain(b).sum()),
            PairAnswer::Undecided => Misclassified::unknown(count),
            PairAnswer::Indistinct => continue,
        };
        let misclassified = all.unwrap_or_default().or_more(of_patch);
        all = Some(misclassified);
        add_pair((a, b, a_from_b), &points, &answer, evidence);
        let so_far =
            settings.recalibration.probability_by_all(deviations, crossing, misclassified.value);
        if so_far > settings.doubt[1] {
            // No doubt is left, and further patches could only say more of the same.
            break;
        }
    }
    Ok(all)
}

fn features(found: &Found<'_>, inside: [f64; 2]) -> [f64; 12] {
    let mut all: Vec<(f64, f64, crossing::Crossing)> =
        found.crossings.iter().map(|(c, s)| (s, s * c.clear, *c)).collect();
    all.sort_by(|p, q| q.0.total_cmp(&p.0));
    let most = &all[..all.len().min(300)];
    let local = |radius: f64, of: &dyn Fn(&(f64, f64, crossing::Crossing)) -> f64| {
        most.iter()
            .map(|(_, _, at)| {
                most.iter()
                    .filter(|(_, _, c)| (c.place - at.place).norm() <= radius * at.spacing)
                    .map(of)
                    .sum::<f64>()
            })
            .fold(0.0, f64::max)
    };
    let strong = all.iter().filter(|c| c.0 > 2.5).count();
    let least = found.findings.iter().min_by(|f, g| f.meeting.deviations.total_cmp(&g.meeting.deviations));
    [
        found.crossings.total(),
        local(2.0, &|c| c.0),
        local(3.0, &|c| c.0),
        local(5.0, &|c| c.0),
        all.iter().map(|c| c.1).sum(),
        local(3.0, &|c| c.1),
        local(5.0, &|c| c.1),
        local(3.0, &|c| c.2.probability),
        strong as f64,
        least.map_or(0.0, |f| f.spacing),
        inside[0],
        inside[1],
    ]
}
