//! A robot along a path of its joints: nothing between the positions given is missed.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::time::Instant;

use cloudtouch::{Checked, PairAnswer, Query, Verdict};

use crate::checker::{RobotChecker, SURROUNDINGS};
use crate::error::PathError;
use crate::stretch::{Pair, between};

/// What is known of a path.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct PathChecked {
    /// What is found at each of the positions given, as [`RobotChecker::check`].
    pub given: Vec<Checked>,
    /// Share of the path, 0 to 1 and the same for every segment, up to which every position is free,
    /// between those given too; 0 where no pair was checked.
    pub certified_free_until: f64,
    /// What is there, where that is not the end; `None` where no pair was checked.
    pub stopped: Option<Stopped>,
    /// The first collision found beyond, where none was found there or at a position given: of sixteen
    /// positions in each segment, so that there may be others.
    pub later: Option<Stopped>,
    /// Positions that were asked about, those given included.
    pub looked_at: usize,
}

/// Where a path is no longer known to be free.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Stopped {
    /// Which segment, from 0.
    pub segment: usize,
    /// Share of the segment, 0 to 1.
    pub t: f64,
    /// The worst pair there; `None` where all read as free, but are so near that positions around
    /// are not known to be.
    pub pair: Option<PairAnswer>,
    /// Then the pair that is least sure around there.
    pub nearest: Option<Nearest>,
}

/// A pair that may meet around a position.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Nearest {
    /// The [`SURROUNDINGS`], a shape of a link or what a link holds, named as in [`RobotChecker::check`].
    pub a: String,
    /// A shape of a link, or what one holds.
    pub b: String,
    /// With at most this probability, which is not below the reject threshold.
    pub at_most: f64,
}

/// Positions within a segment that are looked at for collisions where a path is certified no longer.
const LATER: usize = 16;

/// Stretches are this part of a segment at most, whatever the tolerance: it is a share of the path, which may have
/// hundreds of positions.
const LONGEST: f64 = 0.5;

impl PathChecked {
    /// Whether there was no pair to check at any position: which may touch is the same at all of them.
    pub fn is_unchecked(&self) -> bool {
        self.given.iter().any(Checked::is_unchecked)
    }

    /// Free where the whole path is certified; else the worst verdict found, and undecided where none
    /// but free was, or [no pair was checked](Self::is_unchecked).
    pub fn verdict(&self) -> Verdict {
        let Some(stopped) = &self.stopped else {
            return if self.is_unchecked() { Verdict::Undecided } else { Verdict::Free };
        };
        let found: Vec<Verdict> = (self.given.iter().map(Checked::verdict))
            .chain(stopped.pair.as_ref().map(PairAnswer::verdict))
            .chain(self.later.iter().flat_map(|at| &at.pair).map(PairAnswer::verdict))
            .collect();
        let worst = [Verdict::InCollision, Verdict::Undecided, Verdict::Uncertain];
        worst.into_iter().find(|verdict| found.contains(verdict)).unwrap_or(Verdict::Undecided)
    }
}

impl RobotChecker {
    /// How far along a path every position is free. Between two positions each joint moves straight
    /// from one value to the other, all in the same time.
    ///
    /// Over a stretch a link stays as near to its place in the middle as the turns and shifts of
    /// its joints let it (Schwarzer, Saha, Latombe 2005); if no pose so near to it is as likely to collide as the
    /// reject threshold of the query ([`Query::bound_around`]), the stretch is free. Else it is
    /// halved, down to `tolerance` as a share of the path; there the search ends, and what comes
    /// later is looked at for collisions at the positions given and some between them. A deadline of the query
    /// counts for all of it: once it is over the search ends where it is. Ask with
    /// [`Detail::Full`](cloudtouch::Detail::Full) for contacts and clearances of what is found.
    ///
    /// # Errors
    /// With fewer than two positions, a tolerance below [`Query::LEAST_TOLERANCE`] or above 1, and where
    /// [`Self::check`] has one at any position.
    pub fn check_path(
        &self,
        query: &Query,
        path: &[BTreeMap<String, f64>],
        tolerance: f64,
    ) -> Result<PathChecked, PathError> {
        if path.len() < 2 {
            return Err(PathError::TooFew { count: path.len() });
        }
        if !(Query::LEAST_TOLERANCE..=1.0).contains(&tolerance) {
            return Err(PathError::Tolerance { value: tolerance });
        }
        let at = |(index, joints)| {
            let positions = self.robot.tree.positions(joints);
            positions.map_err(|error| PathError::Joints { index, error })
        };
        let path = path.iter().enumerate().map(at).collect::<Result<Vec<Vec<f64>>, _>>()?;
        // Of a query that began before it is over sooner, and what is looked at until then is known to be undecided.
        let until = query.settings().deadline.and_then(|limit| Instant::now().checked_add(limit));
        let is_over = || until.is_some_and(|until| Instant::now() >= until);
        let query = &query.begun_now();
        let given = path.iter().enumerate().map(|(index, at)| self.check_at(query, index, at));
        let given = given.collect::<Result<_, _>>()?;
        let mut checked = self.certify(query, &path, given, (tolerance, &is_over))?;
        self.look_later(query, &path, &mut checked, &is_over)?;
        Ok(checked)
    }

    /// How far a path is free for certain, given what is found at its positions.
    fn certify(
        &self,
        query: &Query,
        path: &[Vec<f64>],
        given: Vec<Checked>,
        (tolerance, is_over): (f64, &dyn Fn() -> bool),
    ) -> Result<PathChecked, PathError> {
        let mut looked_at = given.len();
        if given.iter().any(Checked::is_unchecked) {
            let (stopped, later) = (None, None);
            return Ok(PathChecked { given, certified_free_until: 0.0, stopped, later, looked_at });
        }
        let segments = (path.len() - 1) as f64;
        let mut certified_free_until = 0.0;
        let at_once = given[0].pairs.first().cloned();
        let mut stopped = at_once.map(|pair| Stopped::at(0, 0.0, Some(pair)));
        for (segment, ends) in path.windows(2).enumerate() {
            // The first time known not to be free, and why: a stretch that ends there is not certain.
            let mut not_free = given[segment + 1].pairs.first().cloned().map(|pair| (1.0, pair));
            // What is before comes first.
            let mut open = vec![[0.0, 1.0]];
            while let (None, Some([from, to])) = (&stopped, open.pop()) {
                looked_at += 1;
                let middle = 0.5 * (from + to);
                let of = |time| between(&ends[0], &ends[1], time);
                let pair = self.check_at(query, segment, &of(middle))?.pairs.into_iter().next();
                let around = || self.around(query, &of(middle), [&of(from), &of(to)]);
                // No number is not below the threshold either.
                let may_meet = |at_most: f64| {
                    at_most.partial_cmp(&query.settings().reject) != Some(Ordering::Less)
                };
                let ends_free = not_free.as_ref().is_none_or(|(time, _)| to < *time);
                if pair.is_none() && ends_free && !around().any(|(_, at_most)| may_meet(at_most)) {
                    certified_free_until = (segment as f64 + to) / segments;
                } else if to - from > (tolerance * segments).min(LONGEST) && !is_over() {
                    not_free = pair.map(|pair| (middle, pair)).or(not_free);
                    open.extend([[middle, to], [from, middle]]);
                } else if let Some(pair) = pair {
                    stopped = Some(Stopped::at(segment, middle, Some(pair)));
                } else if let Some((time, pair)) = not_free.take_if(|_| !ends_free) {
                    stopped = Some(Stopped::at(segment, time, Some(pair)));
                } else {
                    let least_sure = around().max_by(|(_, p), (_, q)| p.total_cmp(q));
                    let nearest = least_sure.map(|(pair, at_most)| self.nearest(pair, at_most));
                    stopped = Some(Stopped { nearest, ..Stopped::at(segment, middle, None) });
                }
            }
        }
        Ok(PathChecked { given, certified_free_until, stopped, later: None, looked_at })
    }

    /// Looks for a collision beyond what is certified, until one is known or the time is over.
    fn look_later(
        &self,
        query: &Query,
        path: &[Vec<f64>],
        checked: &mut PathChecked,
        is_over: &dyn Fn() -> bool,
    ) -> Result<(), PathError> {
        let Some(Stopped { segment: first, t, .. }) = checked.stopped else { return Ok(()) };
        for (segment, time) in later_than((first, t), path.len() - 1) {
            if checked.verdict() == Verdict::InCollision || is_over() {
                break;
            }
            checked.looked_at += 1;
            let joints = between(&path[segment], &path[segment + 1], time);
            let mut found = self.check_at(query, segment, &joints)?.pairs.into_iter();
            let collides = found.find(|pair| pair.verdict() == Verdict::InCollision);
            checked.later = collides.map(|pair| Stopped::at(segment, time, Some(pair)));
        }
        Ok(())
    }

    /// What is found at joints on the way from a position, or at it.
    fn check_at(&self, query: &Query, index: usize, joints: &[f64]) -> Result<Checked, PathError> {
        match self.placed(joints) {
            Ok(scene) => Ok(scene.check(query)),
            Err(error) => Err(PathError::Joints { index, error: error.into() }),
        }
    }

    fn nearest(&self, (a, b): Pair, at_most: f64) -> Nearest {
        let a = a.map_or(SURROUNDINGS, |a| &*self.carried[a].name);
        Nearest { a: a.to_owned(), b: self.carried[b].name.clone(), at_most }
    }
}

impl Stopped {
    fn at(segment: usize, t: f64, pair: Option<PairAnswer>) -> Self {
        Self { segment, t, pair, nearest: None }
    }
}

/// Places to look at beyond one, each as a segment and a share of it, in order.
fn later_than(from: (usize, f64), segments: usize) -> impl Iterator<Item = (usize, f64)> {
    let within = |segment| (1..=LATER).map(move |k| (segment, k as f64 / (LATER + 1) as f64));
    (from.0..segments).flat_map(within).filter(move |&at| at > from)
}
