//! Which pairs have to be asked: the others are known to be free by one test of two boxes.
//!
//! A pair is ruled out only where the query would have answered that it is free: its own first test, of
//! the boxes around both bodies, grown by how far their noise model may move points, by how uncertain
//! they are and by how far their surfaces reach, leaves out everything; what is then said of a pair reads
//! as free; and no doubt speaks against it. Doubts are looked for as for a pair that is asked.

use cloudtouch_bvh::{Sought, urgency_of_roots};
use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::judge::{MOST_DEVIATIONS, probability};
use crate::query::Query;
use crate::range::bad_entry;
use crate::record::Terms;

/// Decides which pairs have to be asked.
#[derive(Debug)]
pub(super) struct BroadPhase {
    terms: Terms,
    /// Whether a pair of which nothing is found reads as free: with most priors it does.
    nothing_is_free: bool,
}

impl BroadPhase {
    pub(super) fn new(query: &Query) -> Self {
        let settings = query.settings();
        let by_geometry = settings.judge.log_odds_by_geometry(MOST_DEVIATIONS, 0.0);
        // Of a pair that is open the classifier could say the most.
        let log_odds = settings.judge.revise(by_geometry, f64::INFINITY);
        let nothing_is_free = probability(log_odds, settings.prior) < settings.reject;
        Self { terms: query.terms_in_scene(), nothing_is_free }
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
        let sought = Sought { within: MOST_DEVIATIONS, margin: 0.0, crossings: true, drift: None };
        let trees = (shape_a.tree(), shape_b.tree());
        match urgency_of_roots(trees, &local, sought) {
            Ok(Some(urgency)) => return Some(urgency),
            Ok(None) if self.nothing_is_free => {}
            Ok(None) | Err(_) => return Some(f64::INFINITY),
        }
        self.terms.doubt_at((shape_a, shape_b), a_from_b).0.map(|_| f64::INFINITY)
    }
}
