//! Points of a cloud deep inside a watertight mesh, which leaf pairs that only see surfaces miss: the
//! limit that section 6 of the paper states.

use cloudtouch_bvh::Visit;
use cloudtouch_geom::{Pose, Vector3, normal};

use crate::cloud::{Prepared, Surfel};
use crate::mesh::Mesh;
use crate::record::{Evidence, Side};

use super::signed::{SignedPoint, add_signed_points};
use super::task::Task;

/// Nodes farther outside than this many standard deviations are not looked into.
const CERTAIN_DEVIATIONS: f64 = 4.75;

/// Adds the points of `cloud` that are expected inside a watertight `mesh`, by the signed distance to
/// it; the others are left to the leaf pairs.
///
/// Ends at the first point above `stop_above`, or when time is over. Nodes are pruned by the signed
/// distance of their centre, which changes by at most a metre per metre, and once a point is found,
/// by what they could still add to it.
pub(super) fn add_points_inside(
    (cloud, side): (&Prepared, Side),
    mesh: &Mesh,
    (mesh_from_cloud, a_from_cloud): (&Pose, &Pose),
    task: &Task<'_>,
    evidence: &mut Evidence,
) {
    let cloud_from_mesh = mesh_from_cloud.inverse();
    let mut inside: Vec<SignedPoint> = Vec::new();
    let mut largest = 0.0_f64;
    cloud.tree().visit_nodes(|node| {
        evidence.stats.nodes_visited += 1;
        if largest > task.settings.stop_above || task.clock.is_over() {
            evidence.widen(1.0);
            return Visit::Prune;
        }
        let obb = node.obb();
        let center = mesh_from_cloud.transform_point(&obb.centre);
        let std = node.max_std();
        let clear = mesh.project(&center).signed_distance - obb.radius() - node.shift();
        let bound = if clear > 0.0 { normal::below_zero(clear, std) } else { 1.0 };
        if clear > CERTAIN_DEVIATIONS * std || bound <= largest {
            evidence.widen(bound);
            return Visit::Prune;
        }
        if node.is_leaf() {
            let (points, computed) = cloud.leaf(node.id());
            evidence.stats.leaf_pairs += 1;
            evidence.stats.leaves_prepared += usize::from(computed);
            let inside_mesh = |p| point_inside(p, mesh, (mesh_from_cloud, &cloud_from_mesh));
            for point in points.iter().filter_map(inside_mesh) {
                largest = largest.max(point.probability);
                inside.push(point);
            }
        }
        Visit::Descend
    });
    add_signed_points(&inside, side, a_from_cloud, evidence);
}

/// A point that is expected inside, with the mesh's surface as the one that separates (eq. 16 with
/// |∇f| = 1).
fn point_inside(
    point: &Surfel,
    mesh: &Mesh,
    (mesh_from_cloud, cloud_from_mesh): (&Pose, &Pose),
) -> Option<SignedPoint> {
    let position = point.point.mean;
    let in_mesh = mesh_from_cloud.transform_point(&position);
    let projection = mesh.project(&in_mesh);
    let distance = projection.signed_distance;
    if distance >= 0.0 {
        return None;
    }
    let outward_in_mesh = (projection.point - in_mesh).try_normalize(0.0);
    let outward = cloud_from_mesh.transform_vector(&outward_in_mesh.unwrap_or_else(Vector3::z));
    let std = point.point.covariance.std_along(&outward);
    Some(SignedPoint {
        index: point.index,
        position,
        probability: normal::below_zero(distance, std),
        surface_point: cloud_from_mesh.transform_point(&projection.point),
        outward,
        distance,
        std,
        spacing: point.spacing,
    })
}
