//! Points of a cloud inside a watertight mesh: deep penetration, which leaves that only see
//! surfaces would miss.

use cloudtouch_bvh::{NodeId, Visit};
use cloudtouch_geom::{Point3, Pose, Vector3, normal};

use super::Mesh;
use crate::cloud::Cloud;

/// Nodes farther outside than this many standard deviations are not looked into.
const CERTAIN_DEVIATIONS: f64 = 4.75;

/// A point of the cloud that is expected inside the mesh.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InsidePoint {
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
    /// How deep it is, m, and the standard deviation of that.
    pub depth: f64,
    pub std: f64,
    /// Distance between samples there, m.
    pub spacing: f64,
}

/// What a pass over the cloud's tree found.
#[derive(Debug, Default)]
pub(crate) struct InsideEvidence {
    pub points: Vec<InsidePoint>,
    /// No point in what was not looked into is inside with more than this probability.
    pub culled_bound: f64,
    pub nodes_visited: usize,
    pub leaves_prepared: usize,
    pub largest: f64,
}

/// Finds the points of `cloud` inside `mesh`, ending at the first one above `stop_above`.
///
/// Nodes are pruned by the signed distance of their centre, which changes by at most a metre per
/// metre.
pub(crate) fn points_inside(
    cloud: &Cloud,
    mesh: &Mesh,
    mesh_from_cloud: &Pose,
    stop_above: f64,
) -> InsideEvidence {
    let mut evidence = InsideEvidence::default();
    let cloud_from_mesh = mesh_from_cloud.inverse();
    cloud.tree().visit_nodes(|node| {
        evidence.nodes_visited += 1;
        if evidence.largest > stop_above {
            evidence.culled_bound = 1.0;
            return Visit::Prune;
        }
        let obb = node.obb();
        let center = mesh_from_cloud.transform_point(&obb.centre);
        let std = node.max_std();
        let clear = mesh.project(&center).signed_distance
            - obb.radius()
            - node.shift();
        if clear > 0.0 && clear >= CERTAIN_DEVIATIONS * std {
            let bound = normal::below_zero(clear, std);
            evidence.culled_bound = evidence.culled_bound.max(bound);
            return Visit::Prune;
        }
        if node.is_leaf() {
            look_into_leaf(cloud, node.id(), mesh, (mesh_from_cloud, &cloud_from_mesh), &mut evidence);
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
    evidence: &mut InsideEvidence,
) {
    let (points, computed) = cloud.leaf(leaf);
    evidence.leaves_prepared += usize::from(computed);
    for point in points {
        let position = point.point.mean;
        let in_mesh = mesh_from_cloud.transform_point(&position);
        let projection = mesh.project(&in_mesh);
        if projection.signed_distance >= 0.0 {
            continue;
        }
        let outward_in_mesh = (projection.point - in_mesh) / -projection.signed_distance;
        let outward = cloud_from_mesh.transform_vector(&outward_in_mesh);
        let std = point.point.covariance.std_along(&outward);
        let probability = normal::below_zero(projection.signed_distance, std);
        evidence.largest = evidence.largest.max(probability);
        evidence.points.push(InsidePoint {
            index: point.index,
            position,
            probability,
            surface_point: cloud_from_mesh.transform_point(&projection.point),
            outward,
            depth: -projection.signed_distance,
            std,
            spacing: point.spacing,
        });
    }
}
