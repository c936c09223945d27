//! Where a leaf pair touches, with what normal, and how wide the gap is there.

use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_svm::Class;

use crate::report::{Clearance, Contact};

use super::classify::{PairAnswer, PairPoint, PairPoints};
use super::surface::Surface;

/// What a leaf pair says about its most probable place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    /// The largest probability of a point of the pair.
    pub probability: f64,
    /// The gap there.
    pub clearance: Clearance,
    /// The contact there; `None` where f is flat.
    pub contact: Option<Contact>,
}

/// The most probable place of a leaf pair; `None` when no surface separates it.
///
/// The contact lies on the separating surface, where its most probable point projects to. The
/// clearance is what the most probable points of the two sides keep from that surface, added up:
/// the gap between the bodies as the probability sees it, negative in overlap.
pub(crate) fn most_probable_place(points: &PairPoints, answer: &PairAnswer) -> Option<Place> {
    let PairAnswer::Separated { surface, a, b } = answer else { return None };
    let reach = extent(points);
    let of_a = foremost(surface, Class::A, &points.a, a, reach)?;
    let of_b = foremost(surface, Class::B, &points.b, b, reach)?;
    // A point across the surface overlaps by at least that, wherever the other side ends.
    let deepest = of_a.own_side.min(of_b.own_side);
    let sum = of_a.own_side + of_b.own_side;
    let mean = if deepest < 0.0 { sum.min(deepest) } else { sum };
    let clearance = Clearance { mean, std: of_a.std.hypot(of_b.std) };
    let witness = if of_a.probability >= of_b.probability { of_a } else { of_b };
    // A point across a curved surface may not find back to it: then it is the contact itself.
    let foot = surface.project(&witness.position, reach).or_else(|| {
        let (_, gradient) = surface.value_and_gradient(&witness.position);
        Some((witness.position, -gradient.try_normalize(0.0)?))
    });
    let contact = foot.map(|(point, normal_a_to_b)| Contact {
        point,
        normal_a_to_b,
        probability: witness.probability,
        clearance_m: clearance.mean,
    });
    Some(Place { probability: witness.probability, clearance, contact })
}

/// The most probable point of one side.
#[derive(Debug, Clone, Copy)]
struct Foremost {
    position: Point3,
    probability: f64,
    /// Distance from the separating surface along the gradient, m, negative across it; to first
    /// order in f, and no farther than the pair is large, when the surface cannot be reached.
    own_side: f64,
    /// Standard deviation of that, m.
    std: f64,
}

fn foremost(
    surface: &Surface,
    class: Class,
    points: &[PairPoint],
    probabilities: &[f64],
    reach: f64,
) -> Option<Foremost> {
    let at = |(point, &probability): (&PairPoint, &f64)| {
        let (value, gradient) = surface.value_and_gradient(&point.point.mean);
        let slope = gradient.norm();
        let direction = gradient.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let first_order = (class.sign() * value / slope).clamp(-reach, reach);
        let foot = surface.project(&point.point.mean, reach);
        let own_side = foot.map_or(first_order, |(foot, _)| {
            first_order.signum() * (foot - point.point.mean).norm()
        });
        Foremost {
            position: point.point.mean,
            probability,
            own_side,
            std: point.point.covariance.std_along(&direction),
        }
    };
    points.iter().zip(probabilities).map(at).max_by(|p, q| {
        // Among equally probable points the one deepest on, or nearest to, the other side.
        p.probability.total_cmp(&q.probability).then(q.own_side.total_cmp(&p.own_side))
    })
}

/// Largest distance of a point of the pair from its middle, m.
fn extent(points: &PairPoints) -> f64 {
    let all = || points.a.iter().chain(&points.b).map(|p| p.point.mean);
    let count = (points.a.len() + points.b.len()) as f64;
    let middle = Point3::from(all().map(|p| p.coords).sum::<Vector3>() / count);
    all().map(|p| (p - middle).norm()).fold(0.0, f64::max)
}
