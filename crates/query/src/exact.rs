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
        return Ok(());
    }
    if !is_distance_wanted {
        return Ok(());
    }
    if let Some([on_a, on_b]) = nearest((a, b), a_from_b)? {
        let clearance = Clearance::new((on_b - on_a).norm(), 0.0);
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
    if collide(bodies, a_from_b)? { Ok(None) } else { nearest(bodies, a_from_b) }
}

/// Whether two meshes that do not collide are within a distance (m) of each other, which costs less than to tell
/// how far they are.
pub(crate) fn are_within(
    bodies: (&Mesh, &Mesh),
    a_from_b: &Pose,
    distance: f64,
) -> Result<bool, QueryError> {
    Ok(match nearest_within(bodies, a_from_b, distance)? {
        ClosestPoints::WithinMargin(on_a, on_b) => (on_b - on_a).length() < distance,
        ClosestPoints::Intersecting => true,
        ClosestPoints::Disjoint => false,
    })
}

/// Whether the surfaces of two meshes cross or touch, or one is inside the other.
pub(crate) fn collide((a, b): (&Mesh, &Mesh), a_from_b: &Pose) -> Result<bool, QueryError> {
    let (pose_a, pose_b) = (math::Pose::IDENTITY, parry_pose(a_from_b));
    let crossing = intersection_test(&pose_a, a.surface(), &pose_b, b.surface())
        .map_err(|_| QueryError::Unsupported)?
        .intersecting;
    if crossing || holds_a_part(a, b, a_from_b) || holds_a_part(b, a, &a_from_b.inverse()) {
        return Ok(true);
    }
    Ok(matches!(nearest_within((a, b), a_from_b, 0.0)?, ClosestPoints::Intersecting))
}

/// The nearest places of two meshes that do not collide.
fn nearest(bodies: (&Mesh, &Mesh), a_from_b: &Pose) -> Result<Option<[Point3; 2]>, QueryError> {
    let point = |v: math::Vector| Point3::new(v.x, v.y, v.z);
    for most in [ROOM * apart_at_most(bodies, a_from_b), f64::MAX] {
        if let ClosestPoints::WithinMargin(on_a, on_b) = nearest_within(bodies, a_from_b, most)? {
            return Ok(Some([point(on_a), point(on_b)]));
        }
    }
    Ok(None)
}

/// One sample in so many is measured for a first guess of a distance, ...
const MEASURED: usize = 40;
/// ... and so often a place goes to the nearest of the other surface and back.
const TURNS: usize = 3;
/// Of a guess, for rounding.
const ROOM: f64 = 1.0 + 1e-6;

/// The distance of two meshes is no more than this, m.
///
/// PERF: parry looks for the nearest places of every triangle within the distance it is given, not within the
/// least so far.
fn apart_at_most((a, b): (&Mesh, &Mesh), a_from_b: &Pose) -> f64 {
    let b_from_a = a_from_b.inverse();
    let on_a = |on_b: &Point3| a.nearest(&a_from_b.transform_point(on_b)).0;
    let gap = |on_b: &Point3| (on_a(on_b) - a_from_b.transform_point(on_b)).norm();
    let measured = b.samples().iter().step_by(MEASURED).map(|sample| (gap(sample), *sample));
    let Some((_, mut place)) = measured.min_by(|(p, _), (q, _)| p.total_cmp(q)) else {
        return f64::MAX;
    };
    for _ in 0..TURNS {
        place = b.nearest(&b_from_a.transform_point(&on_a(&place))).0;
    }
    gap(&place)
}

/// The nearest places of two meshes, as long as these are no farther apart than `most` (m).
fn nearest_within(
    (a, b): (&Mesh, &Mesh),
    a_from_b: &Pose,
    most: f64,
) -> Result<ClosestPoints, QueryError> {
    let (pose_a, pose_b) = (math::Pose::IDENTITY, parry_pose(a_from_b));
    closest_points(&pose_a, a.surface(), &pose_b, b.surface(), most)
        .map_err(|_| QueryError::Unsupported)
}

/// Whether a part of `inner` lies inside `outer`, given that their surfaces do not cross: then one vertex of each
/// says it for all.
fn holds_a_part(outer: &Mesh, inner: &Mesh, outer_from_inner: &Pose) -> bool {
    let is_inside = |vertex| outer.encloses(&outer_from_inner.transform_point(vertex));
    outer.has_solids() && inner.vertices_of_parts().iter().any(is_inside)
}

fn parry_pose(pose: &Pose) -> math::Pose {
    let t = pose.translation();
    let q = pose.rotation();
    math::Pose::from_parts(
        math::Vector::new(t.x, t.y, t.z),
        math::Rotation::from_xyzw(q.i, q.j, q.k, q.w),
    )
}
