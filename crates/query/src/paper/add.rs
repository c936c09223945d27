//! What a leaf pair adds to the evidence.

use cloudtouch_geom::Pose;

use crate::CONTACT_FLOOR;
use crate::classifier::{PairAnswer, PairPoint, PairPoints};
use crate::record::{Evidence, PointProbability, Side};
use crate::report::Contact;
use crate::shape::Shape;

use super::contacts::most_probable_place;

/// Adds what a leaf pair says.
pub(super) fn add_pair(
    (a, b, a_from_b): (Shape<'_>, Shape<'_>, &Pose),
    points: &PairPoints,
    answer: &PairAnswer,
    evidence: &mut Evidence,
) {
    let add_points = |evidence: &mut Evidence, probability: &dyn Fn(Side, usize) -> f64| {
        for (side, points) in [(Side::A, &points.a), (Side::B, &points.b)] {
            for (i, point) in points.iter().enumerate() {
                evidence.add_point(pair_point(side, point, probability(side, i)));
            }
        }
    };
    match answer {
        PairAnswer::Separated { a: of_a, b: of_b, .. } => {
            add_points(evidence, &|side, i| if side == Side::A { of_a[i] } else { of_b[i] });
        }
        PairAnswer::Indistinct => {
            add_points(evidence, &|_, _| 0.5);
            evidence.widen(1.0);
        }
        PairAnswer::Undecided => {
            evidence.stats.undecided += 1;
            evidence.widen(1.0);
        }
    }
    if let Some(place) = most_probable_place(points, answer) {
        evidence.add_clearance(place.probability, place.clearance);
        if place.probability >= CONTACT_FLOOR {
            evidence.add_contact(onto_mesh(place.contact, a, b, a_from_b));
        }
    }
}

fn pair_point(side: Side, point: &PairPoint, probability: f64) -> PointProbability {
    PointProbability {
        side,
        index: point.index,
        position: point.point.mean,
        probability,
        spacing: point.spacing,
    }
}

/// A contact with a mesh lies on the mesh and has its normal: that surface is known better than the
/// one between. Out of a watertight mesh is towards the other body; the normal of an open one
/// takes the side that the separating surface gives it.
fn onto_mesh(contact: Contact, a: Shape<'_>, b: Shape<'_>, a_from_b: &Pose) -> Contact {
    let (mesh, a_from_mesh, towards_b) = match (a, b) {
        (Shape::Mesh(mesh), _) => (mesh, &Pose::identity(), 1.0),
        (_, Shape::Mesh(mesh)) => (mesh, a_from_b, -1.0),
        _ => return contact,
    };
    let in_mesh = a_from_mesh.inverse().transform_point(&contact.point);
    let projection = mesh.project(&in_mesh);
    let point = a_from_mesh.transform_point(&projection.point);
    let normal = projection.triangle.and_then(|triangle| mesh.normal(triangle));
    let Some(normal) = normal else { return Contact { point, ..contact } };
    let mut normal_a_to_b = a_from_mesh.transform_vector(&normal) * towards_b;
    if !mesh.is_watertight() && normal_a_to_b.dot(&contact.normal_a_to_b) < 0.0 {
        normal_a_to_b = -normal_a_to_b;
    }
    Contact { point, normal_a_to_b, ..contact }
}
