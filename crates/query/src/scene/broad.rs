//! Which pairs have to be asked: the others are known to be free by their boxes.
//!
//! A pair is ruled out only where the query would have answered that it is free: nothing of one body is
//! within six deviations of the other, no surface reaches it; what is then said of a pair reads as free; and
//! no doubt speaks against it. Boxes along the axes of the scene rule out most pairs without looking at them;
//! a body that may be doubted however far away it is gets a box without end. What is left takes the query's
//! own first test, of the boxes around both bodies, and is doubted as a pair that is asked.

use std::time::Instant;

use cloudtouch_bvh::urgency_of_roots;
use cloudtouch_geom::{Pose, Vector3};

use crate::body::BodyRef;
use crate::check::coordinates::{LARGEST_COORDINATE, bad_entry};
use crate::classifier::Clock;
use crate::doubt::of_pair::{coarse_beside, is_large_object};
use crate::doubt::warning::Which;
use crate::judge::{Blur, EXTENT_NOISES, MOST_DEVIATIONS, NOISE_KNOTS, probability};
use crate::query::Query;
use crate::record::Terms;
use crate::search::SOUGHT;
use crate::shape::Shape;

use super::near::{Corners, everywhere};

/// What poses and sums may misplace a box by, as a share of the coordinates.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Decides which pairs have to be asked.
#[derive(Debug)]
pub(super) struct BroadPhase {
    terms: Terms,
    clock: Clock,
    /// Whether a pair of which nothing is found reads as free: with most priors it does.
    nothing_is_free: bool,
}

impl BroadPhase {
    pub(super) fn new(query: &Query) -> Self {
        let settings = query.settings();
        // However blurred a pair is: between the knots log odds are between theirs.
        let of_nothing = |blur| {
            let judge = settings.judge.for_blur(blur);
            let [_, most] = judge.with_any_extent(judge.log_odds_by_place(MOST_DEVIATIONS, 0.0));
            most
        };
        let with_noise = |scatter| {
            NOISE_KNOTS[..=EXTENT_NOISES].iter().map(move |&noise| Blur { noise, scatter })
        };
        let blurs = NOISE_KNOTS.into_iter().flat_map(with_noise);
        let by_geometry = blurs.map(of_nothing).fold(f64::NEG_INFINITY, f64::max);
        // Of a pair that is open the classifier could say the most, where it is believed in full.
        let revised = settings.judge.for_blur(Blur::shown(0.0)).revise(by_geometry, f64::INFINITY);
        let log_odds = by_geometry.max(revised);
        let nothing_is_free = probability(log_odds, settings.prior) < settings.reject;
        let clock = query.clock(Instant::now());
        Self { terms: query.among_many().terms(), clock, nothing_is_free }
    }

    /// Beyond this box (in the frame of the scene, m) a body meets nothing that is beyond its own; all of
    /// space for one whose pairs have to be looked at wherever it is. `smallest` is the smallest body of the
    /// scene that has a size, `largest` the largest unless that is this one, and `others` are all but this one, the
    /// smallest first.
    pub(super) fn zone<'a>(
        &self,
        shape: Shape<'_>,
        pose: &Pose,
        smallest: Shape<'_>,
        largest: Option<Shape<'_>>,
        mut others: impl Iterator<Item = Shape<'a>>,
    ) -> Corners {
        // Two such poses are no farther from each other than can be reckoned with.
        let is_placed = pose.translation().norm() < 0.25 * LARGEST_COORDINATE;
        let may_doubt = || {
            let as_smaller = |largest| self.terms.may_doubt((largest, shape), Which::B);
            self.terms.may_doubt((shape, smallest), Which::A) || largest.is_some_and(as_smaller)
        };
        // That of the smallest box need not be the body that a coarse cloud tells least of, nor a cloud, beside which a
        // large mesh is doubted.
        let mut doubts_another = || match shape {
            Shape::Mesh(_) if is_large_object(shape) => others
                .find(|other| matches!(other, Shape::Cloud(_)))
                .is_some_and(|cloud| self.terms.may_doubt((shape, cloud), Which::A)),
            Shape::Mesh(_) => false,
            Shape::Cloud(_) => {
                let coarse = coarse_beside(shape);
                let mut too_small = others.by_ref().take_while(|other| other.size() < coarse);
                too_small.any(|other| self.terms.may_doubt((shape, other), Which::A))
            }
        };
        if !is_placed || !self.nothing_is_free || may_doubt() || doubts_another() {
            return everywhere();
        }
        around(shape, pose)
    }

    /// How urgent it is to ask about a pair, the less the sooner; `None` where it is known to be free.
    pub(super) fn urgency(
        &self,
        (a, b): (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
        is_astray: bool,
    ) -> Option<f64> {
        let (shape_a, shape_b) = (a.shape(), b.shape());
        // What cannot be asked has its error for an answer.
        if bad_entry(a_from_b).is_some() || is_astray {
            return Some(f64::INFINITY);
        }
        let local = shape_a.local_from(&shape_b, a_from_b);
        let trees = (shape_a.tree(), shape_b.tree());
        match urgency_of_roots(trees, &local, SOUGHT) {
            Ok(Some(urgency)) => return Some(urgency),
            Ok(None) if self.nothing_is_free => {}
            Ok(None) | Err(_) => return Some(f64::INFINITY),
        }
        if self.clock.is_over() {
            // Doubts take as long as a query, which is left open without any.
            return Some(f64::INFINITY);
        }
        self.terms.doubt_at((shape_a, shape_b), a_from_b, true).0.map(|_| f64::INFINITY)
    }
}

/// The box around all that a body's points may be within six deviations, and all that its surface reaches.
fn around(shape: Shape<'_>, pose: &Pose) -> Corners {
    let local = pose.after(&Pose::from_translation(shape.origin()));
    // Without a point there is nothing to meet, and nothing saved by saying so.
    let Some(root) = shape.tree().root() else { return everywhere() };
    let centre = local.transform_point(&root.obb().centre);
    let coordinates = pose.translation().amax() + shape.origin().amax() + centre.coords.amax();
    let turned_back = pose.rotation().inverse();
    let half = [0, 1, 2].map(|k| {
        let along = turned_back * Vector3::ith(k, 1.0);
        let beyond = root.reach().max(MOST_DEVIATIONS * root.std_along(&along));
        root.obb().half_width_along(&along) + root.shift() + beyond
    });
    let half = Vector3::from(half).map(|half| half + ROUNDING * (coordinates + half));
    [centre - half, centre + half]
}

#[cfg(test)]
mod tests {
    use cloudtouch_testkit::scene::cuboid;

    use super::*;
    use crate::QuerySettings;
    use crate::mesh::Mesh;

    /// All others were looked at for each, so that the time grew with the square of the bodies.
    #[test]
    fn others_that_no_cloud_is_too_coarse_for_are_not_looked_at() {
        let cube = Mesh::prepare(&cuboid([0.1; 3])).unwrap();
        let shape = Shape::Mesh(&cube);
        let broad = BroadPhase::new(&Query::new(QuerySettings::default()).unwrap());
        let mut looked_at = 0;
        let others = std::iter::repeat_n(shape, 100).inspect(|_| looked_at += 1);
        let [low, _] = broad.zone(shape, &Pose::identity(), shape, Some(shape), others);
        assert!(low.x.is_finite());
        assert!(looked_at <= 1, "{looked_at}");
    }
}
