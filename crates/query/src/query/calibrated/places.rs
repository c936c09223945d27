//! What geometry says of places and points, for the report.

use cloudtouch_geom::Vector3;

use crate::CONTACT_FLOOR;
use crate::record::{CORRELATION_SPACINGS, Evidence, PointProbability, Side};
use crate::report::{Clearance, Contact};

use super::leaf::Leaf;
use super::meeting::probability_at;
use super::search::{Finding, Found};

/// A crossing that is more likely than not is where two leaves touch; else they are apart by the gap
/// of their nearest pieces.
const LIKELY: f64 = 0.5;

/// Adds the place that a finding is about, as geometry sees it.
pub(super) fn add_finding(finding: &Finding, evidence: &mut Evidence) {
    let meeting = &finding.meeting;
    let by_gap = probability_at(meeting.deviations);
    let toward = |axis: Vector3| if axis.dot(&finding.toward_b) < 0.0 { -axis } else { axis };
    let fallback = || finding.toward_b.try_normalize(0.0).unwrap_or_else(Vector3::z);
    let (place, axis, probability, clearance) = match finding.crossing {
        Some(found) if found.probability > LIKELY => {
            let clearance = Clearance { mean: -found.depth, std: found.std };
            (found.place, toward(found.axis), found.probability, clearance)
        }
        _ => {
            let clearance = Clearance { mean: meeting.gap, std: meeting.std };
            (meeting.place, meeting.normal.unwrap_or_else(fallback), by_gap, clearance)
        }
    };
    evidence.add_clearance(probability, clearance);
    if probability >= CONTACT_FLOOR {
        evidence.add_contact(Contact {
            point: place,
            normal_a_to_b: axis,
            probability,
            clearance_m: clearance.mean,
        });
    }
}

pub(super) fn add_leaves(found: &Found<'_>, evidence: &mut Evidence) {
    for (side, leaves) in [(Side::A, &found.leaves_a), (Side::B, &found.leaves_b)] {
        for leaf in leaves.values() {
            add_leaf(side, leaf, evidence);
        }
    }
}

fn add_leaf(side: Side, leaf: &Leaf<'_>, evidence: &mut Evidence) {
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
