//! Points that were measured inside of a closed mesh.

use cloudtouch_geom::{Pose, normal};

use crate::mesh::Mesh;

use super::prepared::Prepared;

/// In index order, each with the probability that it is inside by its own noise.
pub(crate) fn points_inside(
    cloud: &Prepared,
    mesh: &Mesh,
    mesh_from_cloud: &Pose,
) -> Vec<(usize, f64)> {
    let [low, high] = mesh.corners_of_box().map(|corner| corner + mesh.origin());
    let probability = |index: usize| {
        let point = mesh_from_cloud.transform_point(&cloud.point(index));
        let is_in_box = (0..3).all(|k| low[k] <= point[k] && point[k] <= high[k]);
        let distance = if is_in_box { mesh.signed_distance(&point) } else { return None };
        let std = cloud.sensor()[index].max_std();
        (distance < 0.0).then(|| (index, normal::cdf(-distance / std.max(f64::MIN_POSITIVE))))
    };
    (0..cloud.len()).filter_map(probability).collect()
}
