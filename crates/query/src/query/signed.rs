//! A cloud against a watertight mesh: its own surface separates inside from outside, and the
//! signed distance to it is the exact decision function of eq. 16 (|∇f| = 1).
//!
//! It also finds points deep inside, which leaf pairs that only see surfaces would miss.

use cloudtouch_bvh::{NodeId, Visit};
use cloudtouch_geom::{Pose, Vector3, normal};

use crate::classifier::Clock;
use crate::cloud::Cloud;
use crate::mesh::Mesh;
use crate::record::SignedPoint;

/// Nodes farther outside than this many standard deviations are not looked into.
const CERTAIN_DEVIATIONS: f64 = 4.75;

/// What a pass over the cloud's tree found.
#[derive(Debug, Default)]
pub(crate) struct SignedEvidence {
    pub points: Vec<SignedPoint>,
    /// No point in what was not looked into is inside with more than this probability.
    pub culled_bound: f64,
    pub nodes_visited: usize,
    pub leaves_visited: usize,
    pub leaves_prepared: usize,
    largest: f64,
}

/// Finds the points of `cloud` that are, or may be, inside a watertight `mesh`.
///
/// Ends at the first point above `stop_above`, or when time is over. Nodes are pruned by the signed distance of their
/// centre, which changes by at most a metre per metre, and once a point is found, by what they
/// could still add to it.
pub(crate) fn signed_points(
    cloud: &Cloud,
    mesh: &Mesh,
    mesh_from_cloud: &Pose,
    (stop_above, clock): (f64, &Clock),
) -> SignedEvidence {
    let mut evidence = SignedEvidence::default();
    let cloud_from_mesh = mesh_from_cloud.inverse();
    cloud.tree().visit_nodes(|node| {
        evidence.nodes_visited += 1;
        if evidence.largest > stop_above || clock.is_over() {
            evidence.culled_bound = 1.0;
            return Visit::Prune;
        }
        let obb = node.obb();
        let center = mesh_from_cloud.transform_point(&obb.centre);
        let std = node.max_std();
        let clear = mesh.project(&center).signed_distance - obb.radius() - node.shift();
        let bound = if clear > 0.0 { normal::below_zero(clear, std) } else { 1.0 };
        if clear > CERTAIN_DEVIATIONS * std || bound <= evidence.largest {
            evidence.culled_bound = evidence.culled_bound.max(bound);
            return Visit::Prune;
        }
        if node.is_leaf() {
            let poses = (mesh_from_cloud, &cloud_from_mesh);
            look_into_leaf(cloud, node.id(), mesh, poses, &mut evidence);
        }
        Visit::Descend
    });
    evidence
}

fn look_into_leaf(
    cloud: &Cloud,
    leaf: NodeId,
    mesh: &Mesh,
    (mesh_from_cloud, cloud_from_mesh): (&Pose, &Pose),
    evidence: &mut SignedEvidence,
) {
    let (points, computed) = cloud.leaf(leaf);
    evidence.leaves_visited += 1;
    evidence.leaves_prepared += usize::from(computed);
    for point in points {
        let position = point.point.mean;
        let in_mesh = mesh_from_cloud.transform_point(&position);
        let projection = mesh.project(&in_mesh);
        let distance = projection.signed_distance;
        // On the surface itself no direction is outward; any one gives the same ½.
        let outward_in_mesh = ((in_mesh - projection.point) * distance.signum()).try_normalize(0.0);
        let outward = cloud_from_mesh.transform_vector(&outward_in_mesh.unwrap_or_else(Vector3::z));
        let std = point.point.covariance.std_along(&outward);
        let probability = normal::below_zero(distance, std);
        evidence.largest = evidence.largest.max(probability);
        evidence.points.push(SignedPoint {
            index: point.index,
            position,
            probability,
            surface_point: cloud_from_mesh.transform_point(&projection.point),
            outward,
            distance,
            std,
            spacing: point.spacing,
        });
    }
}
