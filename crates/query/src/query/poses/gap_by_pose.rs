//! What the gap between two pieces of surface changes by as the pose does.

use cloudtouch_geom::{Matrix3, Motion, Point3, Vector3};
use nalgebra::Matrix3x6;

use crate::body::BodyRef;
use crate::query::places::spots::{FOOTPRINT_SPACINGS, ONE_PLANE, Spot, common_normal, outward};
use crate::search::{Changes, Finding, Wrench, of_direction, of_place, way_to_triangle};

/// A vector and what it changes by as the body that moves does.
#[derive(Debug, Clone, Copy)]
struct Moved {
    value: Vector3,
    changes: Changes,
}

impl Moved {
    fn fixed(value: Vector3) -> Self {
        Self { value, changes: Changes::zeros() }
    }

    fn plus(&self, other: &Self, factor: f64) -> Self {
        Self {
            value: self.value + other.value * factor,
            changes: self.changes + other.changes * factor,
        }
    }

    fn unit(&self) -> Self {
        let length = self.value.norm();
        let value = self.value / length;
        let across = Matrix3::identity() - value * value.transpose();
        Self { value, changes: across * self.changes / length }
    }

    fn dot(&self, other: &Self) -> (f64, Wrench) {
        let changes = self.changes.tr_mul(&other.value) + other.changes.tr_mul(&self.value);
        (self.value.dot(&other.value), changes)
    }
}

/// Of the gap of a spot that this finding tells, by the same steps as the gap.
pub(super) fn gap_by_pose(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Motion,
    finding: &Finding,
    spot: &Spot,
) -> Wrench {
    // Where A is a mesh, it is easier to see it move and B keep: the opposite.
    let a_moves = matches!(a, BodyRef::Mesh(_));
    let offset = offset((a, b), a_from_b, finding);
    let normals = normals(finding, a_moves);
    let axis = axis((a_moves, finding), normals, &offset, spot);
    let of_mesh = if a_moves { normals[0] } else { normals[1] };
    let known = outward(a, b, &finding.nearest).and(of_mesh);
    let normal = match known {
        Some(known) if known.value.dot(&axis.value).abs() > ONE_PLANE => known,
        _ => axis,
    };
    let turned = normal.value.dot(&spot.normal).signum();
    let normal = Moved { value: normal.value * turned, changes: normal.changes * turned };
    let footprint = FOOTPRINT_SPACINGS * finding.nearest.spacing;
    let reach = reach([(a, normals[0]), (b, normals[1])], &axis, footprint);
    let by_pose = between(&offset, &normal, reach, 2.0 * footprint);
    if a_moves { -by_pose } else { by_pose }
}

/// The normals of the two pieces, of which that of the body that moves turns.
fn normals(finding: &Finding, a_moves: bool) -> [Option<Moved>; 2] {
    let turning = |normal: Option<Vector3>, moves: bool| {
        let changes = |n: &Vector3| if moves { of_direction(n) } else { Changes::zeros() };
        normal.map(|value| Moved { value, changes: changes(&value) })
    };
    let [of_a, of_b] = finding.nearest.normals;
    [turning(of_a, a_moves), turning(of_b, !a_moves)]
}

/// What the gap is along: the common normal of the pieces, or that of the plane that separates them.
fn axis(
    (a_moves, finding): (bool, &Finding),
    normals: [Option<Moved>; 2],
    offset: &Moved,
    spot: &Spot,
) -> Moved {
    match (common_normal(finding), normals) {
        (Some(_), [Some(of_a), Some(of_b)]) => {
            of_a.plus(&of_b, of_a.value.dot(&of_b.value).signum()).unit()
        }
        (Some(_), [only, None] | [None, only]) => only.unwrap_or(Moved::fixed(spot.normal)),
        (None, _) => separating((a_moves, finding), offset),
    }
}

/// What the pieces of clouds reach along the axis to the other, m.
fn reach(pieces: [(BodyRef<'_>, Option<Moved>); 2], axis: &Moved, footprint: f64) -> (f64, Wrench) {
    let mut reach = (0.0, Wrench::zeros());
    for (body, normal) in pieces {
        if matches!(body, BodyRef::Cloud(_)) {
            let (cosine, changes) = normal.map_or((0.0, Wrench::zeros()), |n| n.dot(axis));
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            reach.0 += footprint * sine;
            if sine > 0.0 {
                reach.1 -= changes * (footprint * cosine / sine);
            }
        }
    }
    reach
}

/// Of the distance that an offset leaves between pieces that reach so far along the normal, and so far to
/// their sides.
fn between(offset: &Moved, normal: &Moved, reach: (f64, Wrench), to_sides: f64) -> Wrench {
    let across = normal.dot(offset);
    let aside = offset.plus(normal, -across.0);
    let beyond = (aside.value.norm() - to_sides).max(0.0);
    let apart = match across.0 {
        gap if gap <= 0.0 => across,
        gap if gap <= reach.0 => (0.0, Wrench::zeros()),
        gap => (gap - reach.0, across.1 - reach.1),
    };
    if beyond <= 0.0 {
        return apart.1;
    }
    let apart = if apart.0 > 0.0 { apart } else { (0.0, Wrench::zeros()) };
    // What is aside is across the normal: that this turns within the way counts nothing.
    let away = aside.value.normalize();
    let of_aside = offset.changes.tr_mul(&away) - normal.changes.tr_mul(&away) * across.0;
    (apart.1 * apart.0 + of_aside * beyond) / apart.0.hypot(beyond)
}

/// From the piece of A to that of B.
fn offset((a, b): (BodyRef<'_>, BodyRef<'_>), a_from_b: &Motion, finding: &Finding) -> Moved {
    let nearest = &finding.nearest;
    let value = nearest.b.mean - nearest.a.mean;
    let corners = |body: BodyRef<'_>, triangle: u32| match body {
        BodyRef::Mesh(mesh) => Some(mesh.corners(triangle as usize)),
        BodyRef::Cloud(_) => None,
    };
    let on_mesh = |corners: &[Point3; 3], place: &Point3, way: &Vector3| {
        let joint = nearest.a.covariance.sum(&nearest.b.covariance).matrix();
        match joint.try_inverse() {
            Some(metric) => way_to_triangle(corners, place, way, &metric),
            None => of_place(place),
        }
    };
    let [of_a, of_b] = nearest.between;
    let changes = match (corners(a, of_a), corners(b, of_b)) {
        (Some(corners), _) => -on_mesh(&corners, &nearest.a.mean, &-value),
        (None, Some(corners)) => {
            on_mesh(&corners.map(|corner| a_from_b.point(&corner)), &nearest.b.mean, &value)
        }
        (None, None) => of_place(&nearest.b.mean),
    };
    Moved { value, changes }
}

/// The normal Σ⁻¹δ of the plane that separates two pieces best, where no common normal is known.
fn separating((a_moves, finding): (bool, &Finding), offset: &Moved) -> Moved {
    let nearest = &finding.nearest;
    let fallback = Moved::fixed(finding.meeting.normal.unwrap_or_else(Vector3::z));
    let joint = nearest.a.covariance.sum(&nearest.b.covariance).matrix();
    let Some(inverse) = joint.try_inverse() else { return fallback };
    let value = inverse * offset.value;
    if value.norm() == 0.0 {
        return fallback;
    }
    // What moves is a mesh, or B with its covariance Σ: that changes by [ω]Σ − Σ[ω].
    let turning = if a_moves { Matrix3::zeros() } else { nearest.b.covariance.matrix() };
    let mut of_joint = Matrix3x6::zeros();
    of_joint
        .fixed_columns_mut::<3>(3)
        .copy_from(&(turning * value.cross_matrix() - (turning * value).cross_matrix()));
    Moved { value, changes: inverse * (offset.changes - of_joint) }.unit()
}
