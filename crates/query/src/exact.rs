//! Mesh against mesh: both exact, so the answer is a yes or no with a distance.

use cloudtouch_geom::{Point3, Pose};
use parry3d_f64::math;
use parry3d_f64::query::{ClosestPoints, closest_points, intersection_test};

use crate::error::QueryError;
use crate::mesh::Mesh;
use crate::record::Evidence;
use crate::report::Clearance;

/// Adds what is exactly known of two meshes, their distance where it is wanted; `a_from_b` maps local frames.
pub(crate) fn add_exact(
    (a, b): (&Mesh, &Mesh),
    a_from_b: &Pose,
    is_distance_wanted: bool,
    evidence: &mut Evidence,
) -> Result<(), QueryError> {
    evidence.stats.leaf_pairs = 1;
    if collide((a, b), a_from_b)? {
        evidence.add_certain_collision();
    } else if is_distance_wanted && let Some([on_a, on_b]) = nearest((a, b), a_from_b, f64::MAX)? {
        let clearance = Clearance { mean: (on_b - on_a).norm(), std: 0.0, is_bound: false };
        // Known for certain, however improbable a collision is.
        evidence.add_clearance(1.0, clearance);
    }
    Ok(())
}

/// The two places, on A and on B in the frame of A, where these are nearest to each other; `None` where they
/// collide.
pub(crate) fn nearest_places(
    bodies: (&Mesh, &Mesh),
    a_from_b: &Pose,
) -> Result<Option<[Point3; 2]>, QueryError> {
    if collide(bodies, a_from_b)? { Ok(None) } else { nearest(bodies, a_from_b, f64::MAX) }
}

/// Whether two meshes are within a distance (m) of each other, which costs less than to tell how far they are.
pub(crate) fn are_within(
    bodies: (&Mesh, &Mesh),
    a_from_b: &Pose,
    distance: f64,
) -> Result<bool, QueryError> {
    Ok(collide(bodies, a_from_b)?
        || nearest(bodies, a_from_b, distance)?
            .is_some_and(|[on_a, on_b]| (on_b - on_a).norm() < distance))
}

/// Whether the surfaces of two meshes cross, or one is inside the other.
fn collide((a, b): (&Mesh, &Mesh), a_from_b: &Pose) -> Result<bool, QueryError> {
    let (pose_a, pose_b) = (math::Pose::IDENTITY, parry_pose(a_from_b));
    let crossing = intersection_test(&pose_a, a.surface(), &pose_b, b.surface())
        .map_err(|_| QueryError::Unsupported)?
        .intersecting;
    Ok(crossing || holds_a_part(a, b, a_from_b) || holds_a_part(b, a, &a_from_b.inverse()))
}

/// The nearest places of two meshes that do not collide, as long as these are no farther apart than `most` (m).
fn nearest(
    (a, b): (&Mesh, &Mesh),
    a_from_b: &Pose,
    most: f64,
) -> Result<Option<[Point3; 2]>, QueryError> {
    let (pose_a, pose_b) = (math::Pose::IDENTITY, parry_pose(a_from_b));
    let point = |v: math::Vector| Point3::new(v.x, v.y, v.z);
    match closest_points(&pose_a, a.surface(), &pose_b, b.surface(), most)
        .map_err(|_| QueryError::Unsupported)?
    {
        ClosestPoints::WithinMargin(on_a, on_b) => Ok(Some([point(on_a), point(on_b)])),
        // They touch but for rounding, or are farther apart.
        ClosestPoints::Intersecting | ClosestPoints::Disjoint => Ok(None),
    }
}

/// Whether a part of `inner` lies inside `outer`, given that their surfaces do not cross: then one vertex of each
/// says it for all.
fn holds_a_part(outer: &Mesh, inner: &Mesh, outer_from_inner: &Pose) -> bool {
    let is_inside = |vertex| outer.encloses(&outer_from_inner.transform_point(vertex));
    outer.is_closed() && inner.vertices_of_parts().iter().any(is_inside)
}

fn parry_pose(pose: &Pose) -> math::Pose {
    let t = pose.translation();
    let q = pose.rotation();
    math::Pose::from_parts(
        math::Vector::new(t.x, t.y, t.z),
        math::Rotation::from_xyzw(q.i, q.j, q.k, q.w),
    )
}
