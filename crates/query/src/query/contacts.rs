//! Where a leaf pair touches, with what normal, and how wide the gap is there.

use cloudtouch_geom::{Point3, Vector3};

use crate::report::{Clearance, Contact};

use super::classify::{PairAnswer, PairPoint, PairPoints};
use super::pool::Side;
use super::surface::Surface;

/// What a leaf pair says about its most probable place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// The largest probability of a point of the pair.
    pub probability: f64,
    /// The gap there.
    pub clearance: Clearance,
    /// The contact there, when the point could be brought onto the separating surface.
    pub contact: Option<Contact>,
}

/// The most probable place of a leaf pair; `None` when no surface separates it.
///
/// The contact lies on the separating surface. The clearance is measured between the most probable
/// point and its nearest neighbour on the other side, along the normal: it is the gap between the
/// bodies and not the distance to the surface between them. A point across that surface overlaps
/// by at least its distance from it.
pub(crate) fn most_probable_place(points: &PairPoints, answer: &PairAnswer) -> Option<Place> {
    let PairAnswer::Separated { surface, a, b } = answer else { return None };
    let depth = |p: &PairPoint| surface.value_and_gradient(&p.point.mean).0.abs();
    let of = |side: Side, points: &[PairPoint], probabilities: &[f64]| {
        let best = points.iter().zip(probabilities).max_by(|(p, x), (q, y)| {
            // Among equally probable points the one nearest to the surface.
            x.total_cmp(y).then_with(|| depth(q).total_cmp(&depth(p)))
        });
        best.map(|(point, &probability)| (side, *point, probability))
    };
    let (of_a, of_b) = (of(Side::A, &points.a, a)?, of(Side::B, &points.b, b)?);
    let (side, witness, probability) = if of_a.2 >= of_b.2 { of_a } else { of_b };
    let others = if side == Side::A { &points.b } else { &points.a };
    let nearest = nearest(others, &witness.point.mean)?;

    let reach = extent(points);
    let foot = surface.project(&witness.point.mean, reach);
    let normal_a_to_b = foot.map_or_else(|| normal_at(surface, &witness), |(_, normal)| normal);
    let toward_b = if side == Side::A { 1.0 } else { -1.0 };
    let step = (nearest.point.mean - witness.point.mean) * toward_b;
    let std = |p: &PairPoint| p.point.covariance.std_along(&normal_a_to_b);
    let mut mean = step.dot(&normal_a_to_b);
    let (value, gradient) = surface.value_and_gradient(&witness.point.mean);
    let own_side = (toward_b * value / gradient.norm()).max(-reach);
    if own_side < 0.0 {
        // It lies across the separating surface: an overlap of at least that, even if the nearest
        // sample of the other side is farther still.
        mean = mean.min(own_side);
    }
    let clearance = Clearance { mean, std: std(&witness).hypot(std(&nearest)) };
    let contact = foot.map(|(point, normal_a_to_b)| Contact {
        point,
        normal_a_to_b,
        probability,
        clearance_m: clearance.mean,
    });
    Some(Place { probability, clearance, contact })
}

/// Unit normal at a point, from A to B; zero where the surface is flat.
fn normal_at(surface: &Surface, point: &PairPoint) -> Vector3 {
    let (_, gradient) = surface.value_and_gradient(&point.point.mean);
    (-gradient).try_normalize(0.0).unwrap_or_else(Vector3::zeros)
}

fn nearest(points: &[PairPoint], place: &Point3) -> Option<PairPoint> {
    let distance = |p: &PairPoint| (p.point.mean - place).norm_squared();
    points.iter().min_by(|p, q| distance(p).total_cmp(&distance(q))).copied()
}

/// Largest distance of a point of the pair from its middle, m.
fn extent(points: &PairPoints) -> f64 {
    let all = || points.a.iter().chain(&points.b).map(|p| p.point.mean);
    let count = (points.a.len() + points.b.len()) as f64;
    let middle = Point3::from(all().map(|p| p.coords).sum::<Vector3>() / count);
    all().map(|p| (p - middle).norm()).fold(0.0, f64::max)
}
