//! Mesh against mesh: both exact, so the answer is a yes or no with a distance.

use cloudtouch_geom::{Point3, Pose};
use parry3d_f64::math;
use parry3d_f64::query::{ClosestPoints, closest_points, intersection_test};

use crate::error::QueryError;
use crate::mesh::Mesh;
use crate::record::Evidence;
use crate::report::Clearance;

/// What is known of two exact surfaces.
#[derive(Debug, Clone, Copy)]
struct ExactPair {
    intersecting: bool,
    /// Nearest points of A and of B in A's local frame, when apart.
    nearest: Option<(Point3, Point3)>,
}

/// Adds what is exactly known of two meshes; `a_from_b` maps local frames.
pub(crate) fn add_exact(
    (a, b): (&Mesh, &Mesh),
    a_from_b: &Pose,
    evidence: &mut Evidence,
) -> Result<(), QueryError> {
    let pair = exact_pair(a, b, a_from_b)?;
    evidence.stats.leaf_pairs = 1;
    if pair.intersecting {
        evidence.add_certain_collision();
    }
    if let Some((on_a, on_b)) = pair.nearest {
        let clearance = Clearance { mean: (on_b - on_a).norm(), std: 0.0, is_bound: false };
        // Known for certain, however improbable a collision is.
        evidence.add_clearance(1.0, clearance);
    }
    Ok(())
}

/// The two places, on A and on B in the frame of A, where these are nearest to each other; `None` where they
/// collide.
pub(crate) fn nearest_places(
    (a, b): (&Mesh, &Mesh),
    a_from_b: &Pose,
) -> Result<Option<[Point3; 2]>, QueryError> {
    Ok(exact_pair(a, b, a_from_b)?.nearest.map(|(on_a, on_b)| [on_a, on_b]))
}

/// Tests two meshes with parry.
fn exact_pair(a: &Mesh, b: &Mesh, a_from_b: &Pose) -> Result<ExactPair, QueryError> {
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
