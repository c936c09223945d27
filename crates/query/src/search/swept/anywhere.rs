//! What geometry could say at most anywhere about a pose.

use cloudtouch_bvh::Sought;
use cloudtouch_geom::{Drift, Point3, Pose, Vector3};

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::judge::MOST_DEVIATIONS;
use crate::search::run::SOUGHT;
use crate::stats::Stats;

use super::course::{Anywhere, Course};
use super::drifts::Drifts;
use super::run::{Reach, Way};

/// No unit vector differs from itself by more, however it is turned.
const MOST_TURN: f64 = 2.0;
/// The angle of the arc that stands for a way in all directions, rad: so flat that it adds nothing else.
const ARC: f64 = 1e-4;
/// What its numbers are rounded by, relative.
const ROUNDING: f64 = 1e-6;
/// What an edge meets is no farther from its ends, and from what lies past them, than so many times as far as the
/// surface reaches there.
const EDGE_REACHES: f64 = 4.0;

/// [`reach_of`](super::reach_of) at any pose of B about its own that takes none of its points farther than `way`
/// metres, however it is turned for that.
pub(crate) fn reach_around<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &Pose,
    way: f64,
    is_enough: impl Fn(f64, f64) -> bool,
    stats: &mut Stats,
) -> Result<Reach, QueryError> {
    let samples: Vec<Point3> =
        b.shape().samples().iter().map(|sample| a_from_b.transform_point(sample)).collect();
    let turn = most_turn(&samples, way);
    let middle = samples.iter().map(|sample| sample.coords).sum::<Vector3>();
    let middle = Point3::from(middle / samples.len().max(1) as f64);
    let [of_a, of_b] = [a, b].map(|body| {
        let root = body.shape().tree().root();
        root.map_or([0.0; 3], |root| [root.reach(), root.shift(), root.max_std()])
    });
    let ([reach_a, shift_a, _], [reach_b, shift_b, std_b]) = (of_a, of_b);
    // A piece may be beside the points that it was told by.
    let way = way + turn * shift_b;
    let of_b = Anywhere { way, turn, reach: reach_b, lever: None };
    let most = match a {
        BodyRef::Cloud(_) => EDGE_REACHES * reach_a + reach_b + shift_a + shift_b,
        // Of a large face corners may be far from where it meets B.
        BodyRef::Mesh(_) => f64::INFINITY,
    };
    let of_a = Anywhere { reach: reach_a, lever: Some((middle, most)), ..of_b };
    let drifts = Drifts { of_a: Course::Anywhere(of_a), of_b: Course::Anywhere(of_b) };
    // What a turn adds to deviations, however many of them there may be.
    let margin = MOST_DEVIATIONS * turn.min(1.0) * std_b;
    let drift = in_all_directions(way + turn * reach_b, &middle, b.shape().size());
    let sought = Sought { margin, drift: Some(drift), ..SOUGHT };
    Way::new((a, b), a_from_b, drifts).look(a_from_b, sought, is_enough, stats)
}

/// How far a unit vector can turn where none of these places of a body gets farther than a way (m): of two lines
/// across it, one is turned by no less than where the axis lies between them.
fn most_turn(places: &[Point3], way: f64) -> f64 {
    let farthest = |from: &Point3| {
        places.iter().max_by(|p, q| (*p - from).norm().total_cmp(&(*q - from).norm()))
    };
    let Some(first) = places.first().and_then(farthest) else { return MOST_TURN };
    let along = farthest(first).map_or_else(Vector3::zeros, |last| last - first);
    let aside = places.iter().map(|place| place - first);
    let aside = aside.max_by(|p, q| p.cross(&along).norm().total_cmp(&q.cross(&along).norm()));
    let aside = aside.unwrap_or_else(Vector3::zeros);
    let lever = along.cross(&aside).norm() / (along + aside).norm().max((along - aside).norm());
    // Both ends of either get as far, against one another.
    if lever > 0.0 { (2.0 * way / lever).min(MOST_TURN) } else { MOST_TURN }
}

/// A drift that takes the boxes of a body with such a place in it, and of such a size, no less far than a way (m) in
/// any direction: along its axis it is as long, and across it what a flat arc about a far pivot adds.
fn in_all_directions(way: f64, place: &Point3, size: f64) -> Drift {
    let way = way * (1.0 + ROUNDING) + ARC * size;
    let bend = (ARC - ARC.sin()).hypot(1.0 - ARC.cos());
    let (axis, aside) = (Vector3::x(), Vector3::y() * (way / bend + size));
    let angular = axis * ARC;
    Drift::new(place + aside, axis * way + angular.cross(&aside), angular)
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;
    use proptest::prelude::*;

    use super::*;
    use crate::search::swept::run::tests::pair_of;
    use crate::search::{Course, WITH_EXTENT, search};

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) })]

        /// However B is turned, as long as none of its places goes too far.
        #[test]
        fn no_pose_about_one_has_more_evidence_of_either_kind(
            (mesh, shapes) in (0..3_usize, any::<[bool; 2]>()),
            std in 0.0003_f64..0.012,
            offset in prop::array::uniform3(-0.09..0.09_f64),
            turn in -3.0..3.0_f64,
            way in 0.001..0.03_f64,
            motions in prop::collection::vec(
                (prop::array::uniform3(-1.0..1.0_f64), prop::array::uniform3(-1.0..1.0_f64), 0.0..1.0_f64), 8),
            seed in any::<u64>(),
        ) {
            let [a, b] = pair_of(mesh, shapes, std, seed);
            let pair = (BodyRef::from(&a), BodyRef::from(&b));
            let file = Pose::from_translation_rpy(Vector3::from(offset), [turn, 0.3, 0.0]);
            let local = pair.0.shape().local_from(&pair.1.shape(), &file);
            let mut stats = Stats::default();
            let reach = reach_around(pair, &local, way, |_, _| false, &mut stats).unwrap();
            prop_assert!(reach.is_complete);
            let places: Vec<Point3> = pair.1.shape().dense_samples().collect();
            for (axis, shift, share) in motions {
                let middle = local.transform_point(&Point3::origin()).coords;
                let radius = places.iter().map(|p| p.coords.norm()).fold(0.0, f64::max);
                // Of a turn by an angle no place goes farther than that times its radius.
                let angle = share * way / radius;
                let turned = UnitQuaternion::new(Vector3::from(axis).normalize() * angle);
                let shift = Vector3::from(shift).normalize() * (way * (1.0 - share));
                let about = middle + shift - turned * middle;
                let there = Pose::from_translation_rotation(about, turned).after(&local);
                let found = search(pair, &there, |_| Course::Further(WITH_EXTENT), &mut stats).unwrap();
                prop_assert!(found.deviations >= reach.deviations * (1.0 - 1e-9),
                    "{} below {}", found.deviations, reach.deviations);
                let clearness = found.crossings.clearness();
                prop_assert!(clearness <= reach.clearness * (1.0 + 1e-9) + 1e-9,
                    "{clearness} above {}", reach.clearness);
            }
        }
    }

    #[test]
    fn no_turn_is_larger_than_is_told_and_a_rod_may_turn_about_itself() {
        let [x, y] = [Vector3::x(), Vector3::y()].map(|axis| Point3::from(axis * 0.2));
        let turn = most_turn(&[Point3::origin(), x, y], 0.01);
        // Along the longest of the three sides the axis has a lever of √½ of the others.
        assert!((0.141..0.23).contains(&turn), "{turn}");
        assert_eq!(most_turn(&[Point3::origin(), x], 0.01), MOST_TURN);
    }

    #[test]
    fn boxes_are_taken_as_far_in_any_direction() {
        let (place, size, way) = (Point3::new(0.3, -2.0, 1.0), 0.8, 0.014);
        let drift = in_all_directions(way, &place, size);
        for k in 0..60 {
            let n = crate::spiral::direction(k, 60);
            for aside in [Vector3::zeros(), n * size, -n * size, Vector3::y() * size] {
                let along = drift.along(&n, &(place + aside));
                assert!(way <= along && along < 1.5 * way, "{along} along {n}");
            }
        }
    }
}
