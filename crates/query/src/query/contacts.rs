//! Where a leaf pair touches, with what normal, and how wide the gap is there.

use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_svm::Class;

use crate::report::{Clearance, Contact};

use super::classify::{PairAnswer, PairPoint, PairPoints};
use super::leaf_pair::centroid;
use super::surface::Surface;

/// What a leaf pair says about its most probable place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// The largest probability of a point of the pair.
    pub probability: f64,
    /// The gap there.
    pub clearance: Clearance,
    /// The contact there.
    pub contact: Contact,
}

/// The most probable place of a leaf pair; `None` when no surface separates it.
///
/// The contact lies on the separating surface, where its most probable points project to. The
/// clearance is what the foremost points of the two sides keep from that surface, added up:
/// negative in overlap.
pub(crate) fn most_probable_place(points: &PairPoints, answer: &PairAnswer) -> Option<Place> {
    let PairAnswer::Separated { surface, a, b } = answer else { return None };
    let reach = extent(points);
    let of_a = foremost(surface, Class::A, (&points.a, &points.b), reach)?;
    let of_b = foremost(surface, Class::B, (&points.b, &points.a), reach)?;
    // A point across the surface overlaps by at least that, wherever the other side ends.
    let deepest = of_a.own_side.min(of_b.own_side);
    let sum = of_a.own_side + of_b.own_side;
    let mean = if deepest < 0.0 { sum.min(deepest) } else { sum };
    let clearance = Clearance { mean, std: of_a.std.hypot(of_b.std) };
    let probability = a.iter().chain(b).copied().fold(0.0, f64::max);
    let (point, normal_a_to_b) = foot_of_the_tied(points, (a, b), surface, probability, reach);
    let contact = Contact { point, normal_a_to_b, probability, clearance_m: clearance.mean };
    Some(Place { probability, clearance, contact })
}

/// Points within this share of the largest probability are equally good witnesses: the best plane
/// has the same distance, in standard deviations, from several, and rounding must not choose.
const TIE: f64 = 1e-3;
/// A contact is not farther from the samples it stands for than this many spacings and their noise.
const KNOWN_SPACINGS: f64 = 2.0;

/// Where the middle of the equally probable points projects to on the surface, and the normal there.
///
/// Where the surface is not near, the middle itself is the contact, and the normal is the direction
/// from one leaf to the other.
fn foot_of_the_tied(
    points: &PairPoints,
    (a, b): (&[f64], &[f64]),
    surface: &Surface,
    probability: f64,
    reach: f64,
) -> (Point3, Vector3) {
    let all = points.a.iter().zip(a).chain(points.b.iter().zip(b));
    let tied: Vec<PairPoint> =
        all.filter(|(_, p)| **p >= (1.0 - TIE) * probability).map(|(point, _)| *point).collect();
    let middle = centroid(&tied);
    // The surface is known near the samples; where it bulges away from them it means nothing.
    let known = |p: &PairPoint| KNOWN_SPACINGS * p.spacing + 3.0 * p.point.covariance.std_bound();
    let nearby = tied.iter().map(known).fold(0.0, f64::max).min(reach);
    surface.project(&middle, nearby).unwrap_or_else(|| {
        let across = centroid(&points.b) - centroid(&points.a);
        (middle, across.try_normalize(0.0).unwrap_or_else(Vector3::z))
    })
}

/// The point of one side that is nearest to, or farthest across, the separating surface.
#[derive(Debug, Clone, Copy)]
struct Foremost {
    /// Distance from the separating surface along the gradient, m, negative across it.
    own_side: f64,
    /// Standard deviation of that, m.
    std: f64,
}

fn foremost(
    surface: &Surface,
    class: Class,
    (points, others): (&[PairPoint], &[PairPoint]),
    reach: f64,
) -> Option<Foremost> {
    let first_order = |point: &PairPoint| {
        let (value, gradient) = surface.value_and_gradient(&point.point.mean);
        (class.sign() * value / gradient.norm()).clamp(-reach, reach)
    };
    let distances = points.iter().map(|point| (point, first_order(point)));
    let (point, first_order) = distances.min_by(|p, q| p.1.total_cmp(&q.1))?;
    let foot = surface.project(&point.point.mean, reach);
    let own_side = foot
        .map_or(first_order, |(foot, _)| first_order.signum() * (foot - point.point.mean).norm());
    // A point across the surface is no deeper in the other body than that body's nearest sample is
    // away; f = 0 may bulge farther.
    let nearest = others
        .iter()
        .map(|other| (other.point.mean - point.point.mean).norm())
        .fold(f64::INFINITY, f64::min);
    let own_side = own_side.max(-nearest);
    let (_, gradient) = surface.value_and_gradient(&point.point.mean);
    let direction = gradient.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    Some(Foremost { own_side, std: point.point.covariance.std_along(&direction) })
}

/// Largest distance of a point of the pair from its middle, m.
fn extent(points: &PairPoints) -> f64 {
    let middle = nalgebra::center(&centroid(&points.a), &centroid(&points.b));
    let all = points.a.iter().chain(&points.b);
    all.map(|p| (p.point.mean - middle).norm()).fold(0.0, f64::max)
}
