//! What geometry says of places and points, for the report.

use cloudtouch_geom::{Point3, Vector3};

use crate::CONTACT_FLOOR;
use crate::record::{CORRELATION_SPACINGS, Evidence, PointProbability, Side};
use crate::report::{Clearance, Contact};

use super::leaf::{Leaf, NoisyLeaf};
use super::meeting::probability_at;
use super::crossing::Crossing;
use super::search::{Finding, Found};

/// A crossing that is more likely than not is where two leaves touch; else they are apart by the gap
/// of their nearest pieces.
const LIKELY: f64 = 0.5;

/// Adds the place that a finding is about, as geometry sees it.
pub(super) fn add_finding(finding: &Finding, evidence: &mut Evidence) {
    let meeting = &finding.meeting;
    let fallback = || finding.toward_b.try_normalize(0.0).unwrap_or_else(Vector3::z);
    let clearance = Clearance { mean: meeting.gap, std: meeting.std };
    let axis = meeting.normal.unwrap_or_else(fallback);
    add_place(evidence, (meeting.place, axis), probability_at(meeting.deviations), clearance);
}

/// Adds the place of a crossing that is more likely than not.
pub(super) fn add_crossing(crossing: &Crossing, evidence: &mut Evidence) {
    if crossing.probability > LIKELY {
        let clearance = Clearance { mean: -crossing.depth, std: crossing.std };
        add_place(evidence, (crossing.place, crossing.axis), crossing.probability, clearance);
    }
}

fn add_place(
    evidence: &mut Evidence,
    (point, normal_a_to_b): (Point3, Vector3),
    probability: f64,
    clearance: Clearance,
) {
    evidence.add_clearance(probability, clearance);
    if probability >= CONTACT_FLOOR {
        let clearance_m = clearance.mean;
        evidence.add_contact(Contact { point, normal_a_to_b, probability, clearance_m });
    }
}

pub(super) fn add_leaves(found: &Found<'_>, evidence: &mut Evidence) {
    for (side, leaves) in [(Side::A, &found.leaves_a), (Side::B, &found.leaves_b)] {
        for leaf in leaves.values() {
            if let Leaf::Noisy(leaf) = leaf {
                add_leaf(side, leaf, evidence);
            }
        }
    }
}

fn add_leaf(side: Side, leaf: &NoisyLeaf<'_>, evidence: &mut Evidence) {
    for (surfel, probability) in leaf.probabilities() {
        evidence.add_point(PointProbability {
            side,
            index: Some(surfel.index),
            position: surfel.point.mean,
            probability,
            correlation_length: CORRELATION_SPACINGS * surfel.spacing,
        });
    }
}
