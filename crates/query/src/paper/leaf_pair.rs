//! The points of two leaves, brought into one frame.

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::{Motion, Pose, UncertainPoint, normal};

use crate::classifier::{PairPoint, PairPoints, centroid};
use crate::cloud::{Prepared, Surfel};
use crate::error::SubdivisionError;
use crate::mesh::{Mesh, SampleRegion, four_per_triangle, sample_region};
use crate::shape::Shape;
use crate::stats::Stats;

use super::settings::{MeshPoints, PaperSettings};

/// Around a cloud leaf a mesh is sampled this many spacings farther than the leaf reaches.
const MARGIN_SPACINGS: f64 = 2.0;
/// ... and at least this many standard deviations, so that what is left out cannot matter.
const MARGIN_DEVIATIONS: f64 = 4.75;

/// Gathers the points of leaf `leaf_a` of A and leaf `leaf_b` of B in the local frame of A.
///
/// `None` when a side has no point: a mesh leaf whose triangles do not come near the cloud leaf.
///
/// # Errors
/// When a mesh takes more parts than allowed to be sampled as densely as the cloud.
pub(crate) fn gather(
    (a, leaf_a): (Shape<'_>, NodeId),
    (b, leaf_b): (Shape<'_>, NodeId),
    a_from_b: &Pose,
    settings: &PaperSettings,
    stats: &mut Stats,
) -> Result<Option<PairPoints>, SubdivisionError> {
    let points = match (a, b) {
        (Shape::Cloud(a), Shape::Cloud(b)) => PairPoints {
            a: cloud_points(a, leaf_a, &Pose::identity(), settings, stats),
            b: cloud_points(b, leaf_b, a_from_b, settings, stats),
            a_is_mesh: false,
            b_is_mesh: false,
        },
        (Shape::Cloud(cloud), Shape::Mesh(mesh)) => {
            let near = cloud_points(cloud, leaf_a, &Pose::identity(), settings, stats);
            let b = mesh_points(mesh, leaf_b, &near, a_from_b, settings)?;
            PairPoints { a: near, b, a_is_mesh: false, b_is_mesh: true }
        }
        (Shape::Mesh(mesh), Shape::Cloud(cloud)) => {
            let near = cloud_points(cloud, leaf_b, a_from_b, settings, stats);
            let a = mesh_points(mesh, leaf_a, &near, &Pose::identity(), settings)?;
            PairPoints { a, b: near, a_is_mesh: true, b_is_mesh: false }
        }
        // Two meshes are tested exactly and never come here.
        (Shape::Mesh(_), Shape::Mesh(_)) => PairPoints::default(),
    };
    Ok((!points.a.is_empty() && !points.b.is_empty()).then_some(points))
}

/// No point of a pair that [`gather`] found empty is more probable than this.
pub(crate) fn bound_left_out() -> f64 {
    normal::upper_tail(MARGIN_DEVIATIONS)
}

fn cloud_points(
    cloud: &Prepared,
    leaf: NodeId,
    a_from_cloud: &Pose,
    settings: &PaperSettings,
    stats: &mut Stats,
) -> Vec<PairPoint> {
    let (points, computed) =
        if settings.shared_points { cloud.shared_leaf(leaf) } else { cloud.leaf(leaf) };
    stats.leaves_prepared += usize::from(computed);
    let motion = Motion::from(a_from_cloud);
    let pair_point = |s: &Surfel| PairPoint {
        radius: cloud.ellipsoid_radius(s.index),
        ..PairPoint::from(&s.moved(&motion))
    };
    points.iter().map(pair_point).collect()
}

/// The points that stand for the triangles of a mesh leaf; where they are to be as dense as those of
/// a cloud, only those that come near it.
fn mesh_points(
    mesh: &Mesh,
    leaf: NodeId,
    near: &[PairPoint],
    a_from_mesh: &Pose,
    settings: &PaperSettings,
) -> Result<Vec<PairPoint>, SubdivisionError> {
    let Some(region) = region_around(near, &a_from_mesh.inverse()) else { return Ok(Vec::new()) };
    let indices = mesh.paper_tree().leaf(leaf).map_or(&[][..], |leaf| leaf.primitive_indices());
    let triangles = indices.iter().map(|&t| mesh.corners(t as usize));
    let points = match settings.mesh_points {
        MeshPoints::FourPerTriangle => four_per_triangle(triangles),
        MeshPoints::AsDenseAsCloud => sample_region(triangles, &region, settings.max_mesh_parts)?,
    };
    Ok(points
        .iter()
        .map(|p| PairPoint {
            index: None,
            point: UncertainPoint::exact(a_from_mesh.transform_point(p)),
            spacing: region.spacing,
            radius: None,
        })
        .collect())
}

fn region_around(near: &[PairPoint], mesh_from_a: &Pose) -> Option<SampleRegion> {
    if near.is_empty() {
        return None;
    }
    // The centroid, and not the middle of a box: it turns with the frame.
    let center = centroid(near);
    let reach = near.iter().map(|p| (p.point.mean - center).norm()).fold(0.0, f64::max);
    let std = near.iter().map(|p| p.point.covariance.std_bound()).fold(0.0, f64::max);
    let mut spacings: Vec<f64> = near.iter().map(|p| p.spacing).collect();
    spacings.sort_by(f64::total_cmp);
    let median = spacings[spacings.len() / 2];
    // A single point, or equal ones, have no spacing: their uncertainty sets the scale.
    let spacing = if median > 0.0 { median } else { std.max(1e-3 * center.coords.norm()) };
    Some(SampleRegion {
        center: mesh_from_a.transform_point(&center),
        core: reach,
        radius: reach + (MARGIN_SPACINGS * spacing).max(MARGIN_DEVIATIONS * std),
        spacing: spacing.max(f64::MIN_POSITIVE),
    })
}
