//! Where a leaf pair touches, with what normal, and how wide the gap is there.

use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_svm::Class;

use crate::classifier::{PairAnswer, PairPoint, PairPoints, Surface, centroid};
use crate::report::{Clearance, Contact};

/// What a leaf pair says about its most probable place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
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
pub(super) fn most_probable_place(points: &PairPoints, answer: &PairAnswer) -> Option<Place> {
    let PairAnswer::Separated { surface, a, b } = answer else { return None };
    let reach = extent(points);
    let of_a = foremost(surface, Class::A, (&points.a, &points.b), reach)?;
    let of_b = foremost(surface, Class::B, (&points.b, &points.a), reach)?;
    // A point across the surface overlaps by at least that, wherever the other side ends.
    let deepest = of_a.own_side.min(of_b.own_side);
    let sum = of_a.own_side + of_b.own_side;
    let mean = if deepest < 0.0 { sum.min(deepest) } else { sum };
    let clearance = Clearance { mean, std: of_a.std.hypot(of_b.std), is_bound: false };
    let probability = a.iter().chain(b).copied().fold(0.0, f64::max);
    let (point, normal_a_to_b) = foot_of_the_tied(points, (a, b), surface, probability, reach);
    let contact =
        Contact { point, normal_a_to_b, probability, clearance_m: clearance.mean, area_m2: None };
    Some(Place { probability, clearance, contact })
}

/// Points within this share of the largest probability are equally good witnesses: the best plane
/// has the same distance, in standard deviations, from several, and rounding must not choose.
const TIE: f64 = 1e-3;
/// A contact is not farther from the samples it stands for than this many spacings and their noise.
const KNOWN_SPACINGS: f64 = 2.0;

/// Where the equally probable points project to on the surface, and the normal there: their middle
/// or, where it does not, the one of them whose foot is next to it.
///
/// Where the surface is near none, the middle itself is the contact, and the normal is the
/// direction from one leaf to the other.
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
        // In deep overlap points all around may be equally certain, and their middle far from the
        // surface. The feet are compared, not the points: two points are as far from their middle.
        let feet = tied.iter().filter_map(|p| surface.project(&p.point.mean, nearby));
        let away = |(foot, _): &(Point3, Vector3)| (foot - middle).norm();
        feet.min_by(|p, q| away(p).total_cmp(&away(q))).unwrap_or_else(|| {
            let across = centroid(&points.b) - centroid(&points.a);
            (middle, across.try_normalize(0.0).unwrap_or_else(Vector3::z))
        })
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

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use cloudtouch_bvh::TraversalSettings;
    use cloudtouch_geom::{Covariance, Pose, UncertainPoint, seed};
    use proptest::prelude::*;

    use super::*;
    use crate::classifier::{ClassifierSettings, Clock, by_kernel};
    use crate::mode::Mode;
    use crate::paper::PaperSettings;
    use crate::paper::classify::classify;
    use crate::paper::task::Task;
    use crate::report::Stats;

    const SPACING: f64 = 0.02;

    /// A patch of floor and a bowl `gap` above it, turned and moved; A is the bowl.
    fn bowl_on_floor(gap: f64, bend: f64, noise: f64, draw: u64) -> PairPoints {
        let pose = Pose::from_translation_rpy(Vector3::new(1.0, 2.0, 3.0), [0.3, -0.8, 1.1]);
        let side = |class: u64| {
            let place = |i: u64| {
                let random = |k: u64| seed::unit(seed::derive(draw, class, 10 * i + k)) - 0.5;
                let (x, y) = (0.1 * random(0), 0.1 * random(1));
                let z = if class == 0 { gap + bend * (x * x + y * y) } else { 0.0 };
                let at = Point3::new(x, y, z + noise * 2.0 * random(2));
                let covariance = Covariance::diagonal([noise, noise, 2.0 * noise].map(|s| s * s));
                let point = UncertainPoint { mean: at, covariance }.transformed(&pose);
                PairPoint { index: Some(i as u32), point, spacing: SPACING, radius: None }
            };
            (0..25).map(place).collect()
        };
        PairPoints { a: side(0), b: side(1), ..PairPoints::default() }
    }

    fn swapped(points: &PairPoints) -> PairPoints {
        PairPoints { a: points.b.clone(), b: points.a.clone(), ..PairPoints::default() }
    }

    /// The answer as the calibrated mode trains it for a contact patch, or the paper's mode for a
    /// pair of leaves, so tightly that what is compared does not hang on the tolerance.
    fn answer(points: &PairPoints, mode: Mode) -> PairAnswer {
        let settings = ClassifierSettings { relative_gap: 1e-8, ..ClassifierSettings::default() };
        let stats = &mut Stats::default();
        let clock = Clock::new(Instant::now(), None);
        match mode {
            Mode::Calibrated => by_kernel(points, &settings, &clock, stats).answer,
            Mode::Paper => {
                let of_paper = PaperSettings { plane_first: true, ..PaperSettings::default() };
                let traversal = TraversalSettings::default();
                let task = Task { settings: &of_paper, classifier: settings, traversal, clock };
                classify(points, &task, stats).answer
            }
        }
    }

    fn scenes() -> impl Strategy<Value = (PairPoints, Mode)> {
        let mode = prop_oneof![Just(Mode::Calibrated), Just(Mode::Paper)];
        (-0.01..0.03_f64, 0.0..8.0_f64, 0.0005..0.004_f64, any::<u64>(), mode).prop_map(
            |(gap, bend, noise, draw, mode)| (bowl_on_floor(gap, bend, noise, draw), mode),
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn contacts_lie_on_the_surface_and_normals_lead_down_it((points, mode) in scenes()) {
            let answer = answer(&points, mode);
            let place = most_probable_place(&points, &answer);
            let PairAnswer::Separated { surface, .. } = &answer else {
                prop_assert!(place.is_none());
                return Ok(());
            };
            let contact = place.expect("a surface has a nearest place").contact;
            let (value, gradient) = surface.value_and_gradient(&contact.point);
            let distance = value.abs() / gradient.norm();
            prop_assert!((contact.normal_a_to_b.norm() - 1.0).abs() < 1e-12);
            if distance > 1e-2 * SPACING {
                // Only where f = 0 passes none of the points that the contact stands for.
                let PairAnswer::Separated { a, b, .. } = &answer else { return Ok(()) };
                let all = points.a.iter().zip(a).chain(points.b.iter().zip(b));
                for (point, _) in all.filter(|(_, p)| **p >= contact.probability) {
                    let foot = surface.project(&point.point.mean, SPACING);
                    prop_assert!(foot.is_none(), "{distance} m off a surface at {foot:?}");
                }
                return Ok(());
            }
            // f is positive on the side of A.
            let cosine = -contact.normal_a_to_b.dot(&gradient.normalize());
            prop_assert!(cosine > 1.0 - 1e-12, "cosine {cosine}");
        }

        #[test]
        fn the_other_way_round_the_contact_is_the_same((points, mode) in scenes()) {
            let forth = most_probable_place(&points, &answer(&points, mode));
            let other = swapped(&points);
            let back = most_probable_place(&other, &answer(&other, mode));
            prop_assert_eq!(forth.is_some(), back.is_some());
            let (Some(forth), Some(back)) = (forth, back) else { return Ok(()) };
            prop_assert!((forth.probability - back.probability).abs() < 1e-2);
            let (forth, back) = (forth.contact, back.contact);
            let apart = (forth.point - back.point).norm();
            prop_assert!(apart < 0.1 * SPACING, "{apart} m apart: {forth:?} {back:?}");
            let cosine = -forth.normal_a_to_b.dot(&back.normal_a_to_b);
            prop_assert!(cosine > 0.999, "cosine {cosine}: {forth:?} {back:?}");
        }
    }
}
