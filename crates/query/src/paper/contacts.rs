//! Where a leaf pair touches, with what normal, and how wide the gap is there.

use cloudtouch_geom::Vector3;
use cloudtouch_svm::Class;

use crate::classifier::{PairAnswer, PairPoint, PairPoints, Surface, centroid};
use crate::report::{Clearance, Contact};

use super::tied::foot_of_the_tied;

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
    let clearance = Clearance::new(mean, of_a.std.hypot(of_b.std));
    let probability = a.iter().chain(b).copied().fold(0.0, f64::max);
    let (point, normal_a_to_b) = foot_of_the_tied(points, (a, b), surface, probability, reach);
    let contact =
        Contact { point, normal_a_to_b, probability, clearance_m: clearance.mean, area_m2: None };
    Some(Place { probability, clearance, contact })
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
    use cloudtouch_geom::{Covariance, Point3, Pose, UncertainPoint, seed};
    use proptest::prelude::*;

    use super::*;
    use crate::classifier::{ClassifierSettings, Clock, by_kernel};
    use crate::mode::Mode;
    use crate::paper::PaperSettings;
    use crate::paper::classify::classify;
    use crate::paper::task::Task;
    use crate::stats::Stats;

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

    /// Gap, bend, noise and draw of a bowl on a floor, and the mode: what a failure prints.
    fn scenes() -> impl Strategy<Value = (f64, f64, f64, u64, Mode)> {
        let mode = prop_oneof![Just(Mode::Calibrated), Just(Mode::Paper)];
        (-0.01..0.03_f64, 0.0..8.0_f64, 0.0005..0.004_f64, any::<u64>(), mode)
    }

    /// Whether the surface tells where the contact is: from a ten-thousandth of a spacing aside the
    /// way down to it ends in the same place.
    ///
    /// Far from all samples f is nearly flat or a saddle, and a walk of several steps over it may
    /// end anywhere. Two solutions of one problem differ by as little, up to the gap they are
    /// solved to.
    fn is_told(points: &PairPoints, answer: &PairAnswer) -> bool {
        let contact = |aside: Vector3| {
            let moved = |side: &[PairPoint]| {
                let moved = |&of: &PairPoint| {
                    let mean = of.point.mean + aside;
                    PairPoint { point: UncertainPoint { mean, ..of.point }, ..of }
                };
                side.iter().map(moved).collect()
            };
            let points =
                PairPoints { a: moved(&points.a), b: moved(&points.b), ..PairPoints::default() };
            most_probable_place(&points, answer).map(|place| place.contact)
        };
        let Some(here) = contact(Vector3::zeros()) else { return true };
        let aside = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| axis * 1e-4 * SPACING);
        aside.iter().flat_map(|&step| [step, -step]).filter_map(contact).all(|there| {
            (there.point - here.point).norm() < 1e-2 * SPACING
                && there.normal_a_to_b.dot(&here.normal_a_to_b) > 1.0 - 1e-5
        })
    }

    /// That it makes no difference which side is named first, where the surface tells the contact.
    fn check_both_ways(points: &PairPoints, mode: Mode) -> Result<(), TestCaseError> {
        let (of_forth, other) = (answer(points, mode), swapped(points));
        let of_back = answer(&other, mode);
        let forth = most_probable_place(points, &of_forth);
        let back = most_probable_place(&other, &of_back);
        prop_assert_eq!(forth.is_some(), back.is_some());
        let (Some(forth), Some(back)) = (forth, back) else { return Ok(()) };
        prop_assert!((forth.probability - back.probability).abs() < 1e-2);
        if !is_told(points, &of_forth) || !is_told(&other, &of_back) {
            return Ok(());
        }
        let (forth, back) = (forth.contact, back.contact);
        let apart = (forth.point - back.point).norm();
        prop_assert!(apart < 0.1 * SPACING, "{apart} m apart: {forth:?} {back:?}");
        let cosine = -forth.normal_a_to_b.dot(&back.normal_a_to_b);
        prop_assert!(cosine > 0.999, "cosine {cosine}: {forth:?} {back:?}");
        Ok(())
    }

    #[test]
    fn a_surface_hardly_ever_leaves_the_contact_open() {
        // Else the other way round little would be compared.
        for mode in [Mode::Calibrated, Mode::Paper] {
            for draw in 0..40 {
                let gap = -0.01 + 1e-3 * draw as f64;
                let points = bowl_on_floor(gap, 4.0, 0.002, draw);
                assert!(is_told(&points, &answer(&points, mode)), "{mode:?} {draw}");
            }
        }
    }

    #[test]
    fn a_point_at_the_limit_of_a_tie_took_the_contact_with_it() {
        // One way round it fell short of the largest probability by 1.0006e-3, the other way by
        // 0.9986e-3, and the contacts were 3.8 mm apart.
        let (gap, bend, noise) = (-0.006240201165665036, 7.021665236382411, 0.00315686886843815);
        let points = bowl_on_floor(gap, bend, noise, 16_446_436_043_251_608_551);
        let answer = answer(&points, Mode::Calibrated);
        assert!(is_told(&points, &answer), "nothing is compared");
        check_both_ways(&points, Mode::Calibrated).unwrap();
    }

    #[test]
    fn on_a_long_way_over_flat_f_its_last_digits_chose_the_foot() {
        // The most probable point is 5 cm off f = 0, two and a half spacings: the feet were half a
        // millimetre apart, where the surface bends so much that the normals were 13 degrees apart.
        let (gap, bend, noise) = (0.00987587900312515, 2.9189699553584987, 0.003949027081409036);
        let points = bowl_on_floor(gap, bend, noise, 7_970_520_238_922_897_313);
        assert!(!is_told(&points, &answer(&points, Mode::Calibrated)));
        check_both_ways(&points, Mode::Calibrated).unwrap();
    }

    #[test]
    fn of_feet_equally_far_the_order_of_the_bodies_chose() {
        // Rings about one axis: the surface between them is nowhere near their middle, and all
        // points of a ring are equally probable.
        let ring = |radius: f64| {
            let place = |i: u32| {
                let (sin, cos) = (f64::from(i) * std::f64::consts::FRAC_PI_4).sin_cos();
                let mean = Point3::new(radius * cos, radius * sin, 0.0);
                let covariance = Covariance::isotropic(0.004 * 0.004);
                let point = UncertainPoint { mean, covariance };
                PairPoint { index: Some(i), point, spacing: SPACING, radius: None }
            };
            (0..8).map(place).collect::<Vec<_>>()
        };
        let points = PairPoints { a: ring(0.05), b: ring(0.07), ..PairPoints::default() };
        // Named in another order within its body too.
        let turned = |side: &[PairPoint]| side.iter().rev().copied().collect::<Vec<_>>();
        let other =
            PairPoints { a: turned(&points.b), b: turned(&points.a), ..PairPoints::default() };
        let contact = |points| {
            let place = most_probable_place(points, &answer(points, Mode::Calibrated));
            place.expect("rings are separated").contact.point
        };
        let (forth, back) = (contact(&points), contact(&other));
        assert!((forth - back).norm() < 1e-2 * SPACING, "{forth} and {back}");
        assert!(forth.coords.norm() > 0.05, "the middle of the rings: {forth}");
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn contacts_lie_on_the_surface_and_normals_lead_down_it((gap, bend, noise, draw, mode) in scenes()) {
            let points = bowl_on_floor(gap, bend, noise, draw);
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
        fn the_other_way_round_the_contact_is_the_same((gap, bend, noise, draw, mode) in scenes()) {
            check_both_ways(&bowl_on_floor(gap, bend, noise, draw), mode)?;
        }
    }
}
