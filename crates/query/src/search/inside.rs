//! Points of a cloud inside a closed mesh.

use cloudtouch_bvh::Visit;
use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::cloud::Cloud;
use crate::mesh::Mesh;

pub(super) fn inside((a, b): (BodyRef<'_>, BodyRef<'_>), a_from_b: &Pose) -> [f64; 2] {
    match (a, b) {
        (BodyRef::Cloud(cloud), BodyRef::Mesh(mesh)) => deepest(cloud, mesh, &a_from_b.inverse()),
        (BodyRef::Mesh(mesh), BodyRef::Cloud(cloud)) => deepest(cloud, mesh, a_from_b),
        _ => [0.0; 2],
    }
}

fn deepest(cloud: &Cloud, mesh: &Mesh, mesh_from_cloud: &Pose) -> [f64; 2] {
    let mut best = [0.0_f64; 2];
    if !mesh.is_watertight() {
        return best;
    }
    cloud.tree().visit_nodes(|node| {
        let obb = node.obb();
        let center = mesh_from_cloud.transform_point(&obb.centre);
        let deepest = -mesh.project(&center).signed_distance + obb.radius() + node.shift();
        if deepest <= 0.0 {
            return Visit::Prune;
        }
        if node.is_leaf() {
            for surfel in cloud.leaf(node.id()).0 {
                let at = mesh_from_cloud.transform_point(&surfel.point.mean);
                let depth = -mesh.project(&at).signed_distance;
                let std = (surfel.most_variance.sqrt()).max(1e-12);
                best[0] = best[0].max(depth / std);
                best[1] = best[1].max(depth);
            }
        }
        Visit::Descend
    });
    best
}
