//! The places where two bodies are nearest to touching, as geometry sees them: normals of surfaces,
//! and gaps along them.

use cloudtouch_geom::{Motion, Point3, Pose, Vector3};

use crate::body::BodyRef;
use crate::search::{Crossing, Finding, Found, Inside, Nearest, Wrench, probability_at};

/// A crossing less probable than this is told by the gap of the pieces nearest to it.
const LIKELY: f64 = 0.5;
/// Normals of two pieces with a smaller cosine between them belong to no common plane.
pub(in crate::query) const ONE_PLANE: f64 = 0.7;
/// Between its samples a surface may be so many spacings off the flat pieces that stand for it.
const BEND_SPACINGS: f64 = 0.2;
/// The piece of surface about a sample reaches so many spacings.
pub(in crate::query) const FOOTPRINT_SPACINGS: f64 = 0.5;

/// A place where the bodies touch, overlap or come near.
#[derive(Debug, Clone, Copy)]
pub(in crate::query) struct Spot {
    pub place: Point3,
    /// Unit normal from A to B.
    pub normal: Vector3,
    /// Distance of the surfaces along it, m; negative in overlap.
    pub gap: f64,
    /// Whether the pieces that tell it do not face each other.
    pub is_beside: bool,
    /// Whether the overlap is at least so deep: of surfaces that cross only a part is seen.
    pub is_bound: bool,
    /// Its standard deviation, m.
    pub std: f64,
    /// Distance between samples there, m.
    pub spacing: f64,
    /// How likely the surfaces meet there, by the pieces there alone.
    pub probability: f64,
    pub told_by: ToldBy,
}

/// What tells of a spot.
#[derive(Debug, Clone, Copy)]
pub(in crate::query) enum ToldBy {
    /// Two pieces that face each other: a finding, by its place among all.
    Pieces(usize),
    /// A crossing, whose depth changes so with the pose.
    Crossing(Wrench),
    /// A point inside a closed mesh.
    Inside,
}

/// More spots than this say nothing new of where bodies touch.
const MOST_SPOTS: usize = 400;

/// Where two bodies touch, overlap or come near.
#[derive(Debug)]
pub(in crate::query) struct Spots<'a> {
    pub bodies: (BodyRef<'a>, BodyRef<'a>),
    /// Of their local frames.
    pub pose: Pose,
    pub a_from_b: Motion,
    /// In the order of what they say, likeliest first; the deeper of two that are equally likely. The
    /// order does not depend on that of the search.
    pub sorted: Vec<Spot>,
}

/// The spots of a search.
pub(in crate::query) fn spots<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    pose: &Pose,
    found: &Found<'_>,
    inside: Option<&Inside>,
) -> Spots<'a> {
    let near = |(index, finding)| near((a, b), index, finding);
    let mut pairs: Vec<Spot> = found.findings.iter().enumerate().map(near).collect();
    let likely = found.crossings.iter().filter(|crossing| crossing.probability > LIKELY);
    let mut crossed: Vec<Spot> = likely.map(through).collect();
    // Deep overlaps have thousands: those that are not told need no direction.
    sort(&mut crossed);
    for spot in &mut crossed {
        orient(spot, &pairs);
    }
    pairs.extend(crossed);
    pairs.extend(inside.map(|inside| within(a, inside)));
    sort(&mut pairs);
    Spots { bodies: (a, b), pose: *pose, a_from_b: Motion::from(pose), sorted: pairs }
}

/// Sorts spots, and keeps no more than [`MOST_SPOTS`].
fn sort(spots: &mut Vec<Spot>) {
    let place = |s: &Spot| (s.place.x, s.place.y, s.place.z);
    spots.sort_by(|p, q| {
        let ((px, py, pz), (qx, qy, qz)) = (place(p), place(q));
        (q.probability.total_cmp(&p.probability))
            .then(p.gap.total_cmp(&q.gap))
            .then(px.total_cmp(&qx).then(py.total_cmp(&qy)).then(pz.total_cmp(&qz)))
    });
    spots.truncate(MOST_SPOTS);
}

/// Of the two pieces that are least apart.
fn near((a, b): (BodyRef<'_>, BodyRef<'_>), index: usize, finding: &Finding) -> Spot {
    let Finding { nearest, meeting, toward_b } = finding;
    let offset = nearest.b.mean - nearest.a.mean;
    let axis = common_normal(finding)
        .or(meeting.normal)
        .or_else(|| toward_b.try_normalize(0.0))
        .unwrap_or_else(Vector3::z);
    // What a piece reaches along the axis to the other; a triangle is where it is.
    let reach = |body: BodyRef<'_>, normal: Option<Vector3>| match body {
        BodyRef::Mesh(_) => 0.0,
        BodyRef::Cloud(_) => {
            let sine = normal.map_or(1.0, |n| (1.0 - n.dot(&axis).powi(2)).max(0.0).sqrt());
            FOOTPRINT_SPACINGS * nearest.spacing * sine
        }
    };
    let [of_a, of_b] = nearest.normals;
    let reach = reach(a, of_a) + reach(b, of_b);
    let across = [(of_a, &nearest.a), (of_b, &nearest.b)].map(|(normal, point)| {
        let normal = normal.unwrap_or(axis);
        point.covariance.std_along(&normal) * normal.dot(&axis)
    });
    // Where a piece ends is known to half of what it reaches.
    let of_pieces = across[0].hypot(across[1]).hypot(0.5 * reach);
    let normal = match outward(a, b, nearest) {
        Some(known) if known.dot(&axis).abs() > ONE_PLANE => known,
        // Where the gap is less than what is known of it, the pieces say nothing of the direction.
        _ if axis.dot(&offset).abs() > of_pieces => axis * axis.dot(&offset).signum(),
        _ if axis.dot(toward_b) < 0.0 => -axis,
        _ => axis,
    };
    // The pieces reach to their sides: only what is beyond adds to their distance.
    let across = normal.dot(&offset);
    let aside = (offset - normal * across).norm();
    let beyond = (aside - 2.0 * FOOTPRINT_SPACINGS * nearest.spacing).max(0.0);
    let apart = if across > 0.0 { (across - reach).max(0.0) } else { across };
    let gap = if beyond > 0.0 { apart.max(0.0).hypot(beyond) } else { apart };
    let probability = probability_at(meeting.deviations);
    let (place, spacing) = (meeting.place, nearest.spacing);
    let std = of_pieces.hypot(BEND_SPACINGS * spacing);
    let told_by = ToldBy::Pieces(index);
    let is_beside = beyond > 0.0 || common_normal(finding).is_none();
    Spot { place, normal, gap, is_beside, is_bound: false, std, spacing, probability, told_by }
}

/// The mean of the normals of two pieces that are of one plane, or the only one there is.
pub(in crate::query) fn common_normal(finding: &Finding) -> Option<Vector3> {
    match finding.nearest.normals {
        [Some(a), Some(b)] => {
            let cosine = a.dot(&b);
            (cosine.abs() > ONE_PLANE).then(|| (a + b * cosine.signum()).normalize())
        }
        [Some(only), None] | [None, Some(only)] => Some(only),
        [None, None] => None,
    }
}

/// The direction from A to B by the outside of what a mesh encloses.
pub(in crate::query) fn outward(
    a: BodyRef<'_>,
    b: BodyRef<'_>,
    nearest: &Nearest,
) -> Option<Vector3> {
    let ([of_a, of_b], between) = (nearest.normals, nearest.between);
    match (a, b) {
        (BodyRef::Mesh(mesh), _) if mesh.leads_out(between[0]) => of_a,
        (_, BodyRef::Mesh(mesh)) if mesh.leads_out(between[1]) => of_b.map(|normal| -normal),
        _ => None,
    }
}

/// Of surfaces that cross; which way its normal points is open. How far one has come through the other
/// is the depth of their overlap only where the piece that is passed does not end sooner, and how far
/// that reaches is known to half a spacing.
fn through(crossing: &Crossing) -> Spot {
    let Crossing { place, axis, depth, std, spacing, probability, .. } = *crossing;
    let footprint = FOOTPRINT_SPACINGS * spacing;
    let (gap, std) = (-depth.min(footprint), std.hypot(0.5 * footprint));
    let told_by = ToldBy::Crossing(crossing.by_pose.depth);
    let (is_beside, is_bound, normal) = (false, true, axis);
    Spot { place, normal, gap, is_beside, is_bound, std, spacing, probability, told_by }
}

/// A crossing has no direction of its own: it takes that of the nearest pair of pieces.
fn orient(crossed: &mut Spot, pairs: &[Spot]) {
    let distance = |spot: &&Spot| (spot.place - crossed.place).norm_squared();
    let nearest = pairs.iter().min_by(|p, q| distance(p).total_cmp(&distance(q)));
    if nearest.is_some_and(|spot| spot.normal.dot(&crossed.normal) < 0.0) {
        crossed.normal = -crossed.normal;
    }
}

/// Of a point inside a closed mesh.
fn within(a: BodyRef<'_>, inside: &Inside) -> Spot {
    let Inside { deviations, depth, std, place, outward, spacing } = *inside;
    let normal = if matches!(a, BodyRef::Mesh(_)) { outward } else { -outward };
    let probability = 1.0 - probability_at(std::f64::consts::SQRT_2 * deviations);
    let (gap, told_by) = (-depth, ToldBy::Inside);
    let (is_beside, is_bound) = (false, true);
    Spot { place, normal, gap, is_beside, is_bound, std, spacing, probability, told_by }
}
