//! Mesh against mesh: both exact, so the answer is a yes or no with a distance.

use cloudtouch_geom::{Point3, Pose};
use parry3d_f64::math;
use parry3d_f64::query::{ClosestPoints, closest_points, intersection_test};

use crate::error::QueryError;
use crate::mesh::Mesh;

/// What is known of two exact surfaces.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ExactPair {
    pub intersecting: bool,
    /// Nearest points of A and of B in A's local frame, when apart.
    pub nearest: Option<(Point3, Point3)>,
}

/// Tests two meshes with parry; `a_from_b` maps local frames.
pub(crate) fn exact_pair(a: &Mesh, b: &Mesh, a_from_b: &Pose) -> Result<ExactPair, QueryError> {
    let unsupported = |_| QueryError::Unsupported;
    let pose_a = math::Pose::IDENTITY;
    let pose_b = parry_pose(a_from_b);
    let crossing = intersection_test(&pose_a, a.surface(), &pose_b, b.surface())
        .map_err(unsupported)?
        .intersecting;
    if crossing || contains_a_vertex(a, b, a_from_b) || contains_a_vertex(b, a, &a_from_b.inverse())
    {
        return Ok(ExactPair { intersecting: true, nearest: None });
    }
    let pair = closest_points(&pose_a, a.surface(), &pose_b, b.surface(), f64::MAX)
        .map_err(unsupported)?;
    let point = |v: math::Vector| Point3::new(v.x, v.y, v.z);
    Ok(match pair {
        ClosestPoints::WithinMargin(on_a, on_b) => {
            ExactPair { intersecting: false, nearest: Some((point(on_a), point(on_b))) }
        }
        ClosestPoints::Intersecting => ExactPair { intersecting: true, nearest: None },
        ClosestPoints::Disjoint => ExactPair { intersecting: false, nearest: None },
    })
}

/// Whether `inner` lies inside `outer`, given that their surfaces do not cross: then one vertex
/// per connected part would do, and testing all of them costs little beside the distance.
fn contains_a_vertex(outer: &Mesh, inner: &Mesh, outer_from_inner: &Pose) -> bool {
    inner
        .surface()
        .vertices()
        .iter()
        .any(|v| outer.encloses(&outer_from_inner.transform_point(&Point3::new(v.x, v.y, v.z))))
}

fn parry_pose(pose: &Pose) -> math::Pose {
    let t = pose.translation();
    let q = pose.rotation();
    math::Pose::from_parts(
        math::Vector::new(t.x, t.y, t.z),
        math::Rotation::from_xyzw(q.i, q.j, q.k, q.w),
    )
}
