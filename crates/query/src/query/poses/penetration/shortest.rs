//! In which direction it is out the soonest.

use cloudtouch_geom::Vector3;

use super::along::{ROUGHLY, Way};
use super::overlap::Overlap;
use crate::error::QueryError;
use crate::query::poses::directions::{ring, sphere};
use crate::query::run::Query;

/// A direction no farther than this from one that was looked along is not another, rad: contacts of one face
/// share their normal, and often an axis with it.
const SAME: f64 = 0.1;
/// A direction that is not free at this share of the shortest way out is given up.
pub(super) const SHORTER: f64 = 0.97;
/// Of directions that nothing speaks for, a place this much nearer is tried too: on the way there may be
/// something else.
const NEARER: f64 = 0.6;
/// How often a direction is turned to the normal of the surfaces at the end of the way.
const TURNS: usize = 4;
/// Then others at these angles from it are tried, rad.
const ANGLES: [f64; 3] = [0.3, 0.15, 0.07];
/// Along a direction that is likely to be short places much nearer are tried too.
const MUCH_SHORTER: [f64; 5] = [SHORTER, 0.5, 0.25, 0.125, 0.0625];

impl Overlap<'_> {
    /// The shortest way found, if any: along directions in which one is likely, then evenly in all. And the unit
    /// vectors that were looked along.
    pub(super) fn shortest(
        &self,
        likely: impl Iterator<Item = Vector3>,
    ) -> Result<(Option<Way>, Vec<Vector3>), QueryError> {
        let (mut best, mut known) = (None, Vec::new());
        for direction in likely.filter_map(|d| d.try_normalize(0.0)) {
            if is_another(&mut known, direction) {
                best = self.shorter(best, direction, &MUCH_SHORTER)?;
            }
        }
        for direction in sphere() {
            if is_another(&mut known, direction) {
                best = self.shorter(best, direction, &[SHORTER, NEARER])?;
            }
        }
        Ok((best, known))
    }

    /// The best of a way, if there is one, and another along `direction`.
    fn shorter(
        &self,
        best: Option<Way>,
        direction: Vector3,
        shares: &[f64],
    ) -> Result<Option<Way>, QueryError> {
        match best {
            Some(best) => self.shortened(best, direction, shares).map(Some),
            None => self.first_way(direction),
        }
    }

    /// The best of a way and those along the normals of the surfaces at its end, as long as these are shorter.
    pub(super) fn turned_to_normals(
        &self,
        mut best: Way,
        query: &Query,
    ) -> Result<Way, QueryError> {
        for _ in 0..TURNS {
            let before = best;
            if let Some(normal) = self.normal_at(best.direction * best.free, query)? {
                best = self.shortened(best, normal, &[SHORTER])?;
            }
            if best.free > SHORTER * before.free {
                break;
            }
        }
        Ok(best)
    }

    /// The best of ways a little aside.
    pub(super) fn turned_aside(&self, mut best: Way) -> Result<Way, QueryError> {
        for angle in ANGLES {
            let around = best.direction;
            for direction in ring(&around, angle) {
                best = self.shortened(best, direction, &[SHORTER])?;
            }
        }
        Ok(best)
    }

    /// The best way, or one along `direction` that is free at one of these shares of it.
    pub(super) fn shortened(
        &self,
        best: Way,
        direction: Vector3,
        shares: &[f64],
    ) -> Result<Way, QueryError> {
        for share in shares {
            let free = share * best.free;
            if self.is_free(direction * free)? {
                return self.between(Way { direction, stuck: 0.0, free }, ROUGHLY);
            }
        }
        Ok(best)
    }
}

/// Whether a direction is none of those known, to which it is added.
fn is_another(known: &mut Vec<Vector3>, direction: Vector3) -> bool {
    let is_new = known.iter().all(|other| other.dot(&direction) < SAME.cos());
    if is_new {
        known.push(direction);
    }
    is_new
}
