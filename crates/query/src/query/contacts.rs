//! Where a leaf pair touches, with what normal, and how wide the gap is there.

use cloudtouch_geom::{Point3, Vector3};

use crate::report::{Clearance, Contact};

use super::classify::{PairAnswer, PairPoint, PairPoints};
use super::surface::Surface;

/// The contact and the clearance of one leaf pair, at its most probable point.
///
/// The contact lies on the separating surface; the clearance is measured along its normal between
/// the foremost point of A and the foremost point of B nearby, so it is the gap between the
/// surfaces and not the distance to the surface between them.
pub(crate) fn contact_of(points: &PairPoints, answer: &PairAnswer) -> Option<(Contact, Clearance)> {
    let PairAnswer::Separated { surface, a, b } = answer else { return None };
    let candidates = points.a.iter().zip(a).chain(points.b.iter().zip(b));
    let (witness, &probability) = candidates.max_by(|(p, x), (q, y)| {
        // Among equally probable points the one nearest to the surface.
        let depth = |p: &PairPoint| surface.value_and_gradient(&p.point.mean).0.abs();
        x.total_cmp(y).then_with(|| depth(q).total_cmp(&depth(p)))
    })?;
    let reach = extent(points);
    let (foot, normal_a_to_b) = foot_of(surface, &witness.point.mean, reach)?;
    let clearance = gap_along(points, &foot, &normal_a_to_b, witness.spacing);
    let contact = Contact { point: foot, normal_a_to_b, probability, clearance_m: clearance.mean };
    Some((contact, clearance))
}

fn foot_of(surface: &Surface, point: &Point3, reach: f64) -> Option<(Point3, Vector3)> {
    let (foot, normal) = surface.project(point, reach)?;
    normal.iter().all(|v| v.is_finite()).then_some((foot, normal))
}

/// Largest distance of a point of the pair from its middle, m.
fn extent(points: &PairPoints) -> f64 {
    let all = || points.a.iter().chain(&points.b).map(|p| p.point.mean);
    let count = (points.a.len() + points.b.len()) as f64;
    let middle = Point3::from(all().map(|p| p.coords).sum::<Vector3>() / count);
    all().map(|p| (p - middle).norm()).fold(0.0, f64::max)
}

/// Gap between the foremost points of the two sides near `foot`, along `normal`.
fn gap_along(points: &PairPoints, foot: &Point3, normal: &Vector3, spacing: f64) -> Clearance {
    // Heights along the normal grow from A to B, so A's foremost point is its highest.
    let (top, top_std) = foremost(&points.a, foot, normal, spacing);
    let (bottom, bottom_std) = foremost(&points.b, foot, &-normal, spacing);
    Clearance { mean: -bottom - top, std: top_std.hypot(bottom_std) }
}

/// Height along `direction` of the foremost point near `foot`, and its standard deviation.
fn foremost(side: &[PairPoint], foot: &Point3, direction: &Vector3, spacing: f64) -> (f64, f64) {
    let across = |p: &PairPoint| {
        let offset = p.point.mean - foot;
        (offset - direction * offset.dot(direction)).norm()
    };
    // The nearest point counts in any case; others count when about as near.
    let nearest = side.iter().map(across).fold(f64::INFINITY, f64::min);
    let radius = nearest + 1.5 * spacing;
    side.iter()
        .filter(|p| across(p) <= radius)
        .map(|p| ((p.point.mean - foot).dot(direction), p.point.covariance.std_along(direction)))
        .max_by(|p, q| p.0.total_cmp(&q.0))
        .unwrap_or((f64::NEG_INFINITY, 0.0))
}
