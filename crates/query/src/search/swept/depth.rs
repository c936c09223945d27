//! How deep a cloud can get inside a closed mesh while one of them drifts.

use cloudtouch_bvh::Visit;
use cloudtouch_geom::{Drift, Point3, Pose};

use crate::body::BodyRef;
use crate::judge::MOST_DEVIATIONS;
use crate::search::in_mesh::InMesh;
use crate::stats::Stats;

/// A way is looked at in so many halvings before it is looked at closer.
const HALVINGS: u32 = 4;

/// Deviations, at most, up to where `is_enough` of them; 0 where no point gets inside, or neither body is
/// a closed mesh. No place gets deeper by more than it drifts. [`MOST_DEVIATIONS`] outweigh everything
/// else. Local frames.
pub(crate) fn greatest_depth(
    bodies: (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    drift: &Drift,
    is_enough: impl Fn(f64) -> bool,
    stats: &mut Stats,
) -> f64 {
    let mut most = 0.0;
    let Some(bodies) = InMesh::of(bodies, a_from_b) else { return most };
    let InMesh { cloud, mesh, a_from_cloud, a_from_mesh, .. } = bodies;
    // Of the cloud, as the mesh sees it.
    let drift = if bodies.mesh_is_a { *drift } else { drift.inverse() };
    let mesh_from_a = a_from_mesh.inverse();
    let to_mesh = |in_a: &Point3| mesh_from_a.transform_point(in_a);
    // What is outside all along its way, and all about it, does not get inside.
    let way_of = |in_a: &Point3, radius: f64| {
        let way = drift.first_order(in_a);
        let beside = radius * (1.0 + drift.turn()) + drift.beyond_first_order(in_a, 0.0);
        ([to_mesh(&(in_a - way)), to_mesh(&(in_a + way))], beside)
    };
    let surely_stays_clear = |([from, to], beside): &([Point3; 2], f64)| {
        mesh.is_surely_clear_of_way([from, to], *beside, HALVINGS)
    };
    let stays_clear = |way: &([Point3; 2], f64)| {
        let ([from, to], beside) = way;
        surely_stays_clear(way) || mesh.is_clear_of_way([from, to], *beside)
    };
    cloud.tree().visit_nodes(|node| {
        stats.nodes_visited += 1;
        if is_enough(most) || most >= MOST_DEVIATIONS {
            return Visit::Prune;
        }
        let obb = node.obb();
        let in_a = a_from_cloud.transform_point(&obb.centre);
        let way = way_of(&in_a, obb.radius() + node.shift());
        // Above the leaves it costs less to go on than to look closer.
        if !node.is_leaf() {
            return if surely_stays_clear(&way) { Visit::Prune } else { Visit::Descend };
        }
        if !stays_clear(&way) {
            let (surfels, computed) = cloud.leaf(node.id());
            stats.leaves_prepared += usize::from(computed);
            for surfel in surfels {
                let in_a = a_from_cloud.transform_point(&surfel.point.mean);
                if stays_clear(&way_of(&in_a, 0.0)) {
                    continue;
                }
                let distance = mesh.project(&to_mesh(&in_a)).signed_distance;
                let depth = drift.in_any_direction(&in_a) - distance;
                let std = surfel.most_variance.sqrt().max(f64::MIN_POSITIVE);
                most = most.max(depth / std);
            }
        }
        Visit::Descend
    });
    most
}
