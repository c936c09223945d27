//! Points of a cloud at their signed distance from a watertight mesh.

use cloudtouch_geom::{Point3, Pose, Vector3};

use crate::CONTACT_FLOOR;
use crate::record::{Evidence, PointProbability, Side};
use crate::report::{Clearance, Contact};

/// A point of the cloud at its signed distance from the mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct SignedPoint {
    /// Index in the prepared cloud.
    pub index: u32,
    /// Its expected position, in the cloud's local frame.
    pub position: Point3,
    /// Probability that the true point is inside.
    pub probability: f64,
    /// The nearest point of the mesh, in the cloud's local frame.
    pub surface_point: Point3,
    /// Unit normal of the mesh there, pointing out of the mesh.
    pub outward: Vector3,
    /// Signed distance, m, negative inside, and its standard deviation.
    pub distance: f64,
    pub std: f64,
    /// Distance between samples there, m.
    pub spacing: f64,
}

/// Adds points by their signed distance from a watertight mesh.
pub(super) fn add_signed_points(
    points: &[SignedPoint],
    side: Side,
    a_from_cloud: &Pose,
    evidence: &mut Evidence,
) {
    for point in points {
        evidence.add_point(PointProbability {
            side,
            index: Some(point.index),
            position: a_from_cloud.transform_point(&point.position),
            probability: point.probability,
            spacing: point.spacing,
        });
        let clearance = Clearance::new(point.distance, point.std);
        evidence.add_clearance(point.probability, clearance);
        if point.probability >= CONTACT_FLOOR {
            evidence.add_contact(signed_contact(point, side, a_from_cloud));
        }
    }
}

fn signed_contact(point: &SignedPoint, cloud_side: Side, a_from_cloud: &Pose) -> Contact {
    // Out of the mesh is towards the cloud's body; the normal runs from A to B.
    let outward = a_from_cloud.transform_vector(&point.outward);
    Contact {
        point: a_from_cloud.transform_point(&point.surface_point),
        normal_a_to_b: if cloud_side == Side::A { -outward } else { outward },
        probability: point.probability,
        clearance_m: point.distance,
        area_m2: None,
    }
}
