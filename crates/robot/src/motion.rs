//! A robot along a path of its joints: nothing between the positions given is missed.

use std::collections::BTreeMap;

use cloudtouch::{BodyRef, Checked, PairAnswer, Query, Verdict};

use crate::checker::{RobotChecker, SURROUNDINGS};
use crate::error::PathError;
use crate::joint::JointKind;
use crate::tree::Tree;

/// What is known of a path.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct PathChecked {
    /// What is found at each of the positions given, as [`RobotChecker::check`].
    pub given: Vec<Checked>,
    /// Share of the path, 0 to 1 and the same for every segment, up to which every position is free,
    /// between those given too.
    pub certified_free_until: f64,
    /// What is there, where that is not the end.
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

impl PathChecked {
    /// Free where the whole path is certified; else the worst verdict found, and undecided where none
    /// but free was.
    pub fn verdict(&self) -> Verdict {
        let Some(stopped) = &self.stopped else { return Verdict::Free };
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
    /// its joints let it (Schwarzer, Saha, Latombe 2005); if no surface is within that distance there by
    /// [`Query::within`], with the reject threshold of the query, the stretch is free. Else it is
    /// halved, down to `tolerance` as a share of the path; there the search ends, and what comes
    /// later is looked at for collisions at the positions given and some between them. A deadline of the query
    /// counts for all of it. Ask with
    /// [`Detail::Full`](cloudtouch::Detail::Full) for contacts and clearances of what is found.
    ///
    /// # Errors
    /// With fewer than two positions, a tolerance that is not above 0 and at most 1, and where
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
        if !(tolerance > 0.0 && tolerance <= 1.0) {
            return Err(PathError::Tolerance { value: tolerance });
        }
        let at = |(index, joints)| {
            let positions = self.robot.tree.positions(joints);
            positions.map_err(|error| PathError::Joints { index, error })
        };
        let path = path.iter().enumerate().map(at).collect::<Result<Vec<Vec<f64>>, _>>()?;
        let query = &query.begun_now();
        let given = path.iter().enumerate().map(|(index, at)| self.check_at(query, index, at));
        let given = given.collect::<Result<_, _>>()?;
        let mut checked = self.certify(query, &path, given, tolerance)?;
        self.look_later(query, &path, &mut checked)?;
        Ok(checked)
    }

    /// How far a path is free for certain, given what is found at its positions.
    fn certify(
        &self,
        query: &Query,
        path: &[Vec<f64>],
        given: Vec<Checked>,
        tolerance: f64,
    ) -> Result<PathChecked, PathError> {
        let mut looked_at = given.len();
        let segments = (path.len() - 1) as f64;
        let mut certified_free_until = 0.0;
        let at_once = given[0].pairs.first().cloned();
        let mut stopped = at_once.map(|pair| Stopped::at(0, 0.0, Some(pair)));
        for (segment, ends) in path.windows(2).enumerate() {
            // What is before comes first.
            let mut open = vec![[0.0, 1.0]];
            while let (None, Some([from, to])) = (&stopped, open.pop()) {
                looked_at += 1;
                let middle = 0.5 * (from + to);
                let of = |time| between(&ends[0], &ends[1], time);
                let pair = self.check_at(query, segment, &of(middle))?.pairs.into_iter().next();
                let around = || self.around(query, &of(middle), [&of(from), &of(to)]);
                let may_meet = |at_most: f64| at_most >= query.settings().reject;
                if pair.is_none() && !around().any(|(_, at_most)| may_meet(at_most)) {
                    certified_free_until = (segment as f64 + to) / segments;
                } else if to - from <= tolerance * segments {
                    let least_sure = around().max_by(|(_, p), (_, q)| p.total_cmp(q));
                    let nearest = least_sure.filter(|_| pair.is_none());
                    let nearest = nearest.map(|(pair, at_most)| self.nearest(pair, at_most));
                    stopped = Some(Stopped { nearest, ..Stopped::at(segment, middle, pair) });
                } else {
                    open.extend([[middle, to], [from, middle]]);
                }
            }
            if stopped.is_none() {
                let pair = given[segment + 1].pairs.first().cloned();
                stopped = pair.map(|pair| Stopped::at(segment, 1.0, Some(pair)));
            }
        }
        Ok(PathChecked { given, certified_free_until, stopped, later: None, looked_at })
    }

    /// Looks for a collision beyond what is certified, until one is known.
    fn look_later(
        &self,
        query: &Query,
        path: &[Vec<f64>],
        checked: &mut PathChecked,
    ) -> Result<(), PathError> {
        let Some(Stopped { segment: first, t, .. }) = checked.stopped else { return Ok(()) };
        for (segment, time) in later_than((first, t), path.len() - 1) {
            if checked.verdict() == Verdict::InCollision {
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

    /// Of every pair that may touch the largest probability that it meets on the way from one position to the
    /// other, of which `middle` is the middle: of the surroundings (`None`) or a part, and another part.
    fn around<'a>(
        &'a self,
        query: &'a Query,
        middle: &[f64],
        ends: [&[f64]; 2],
    ) -> impl Iterator<Item = (Pair, f64)> + use<'a> {
        let (tree, parts) = (&self.robot.tree, &self.carried);
        let poses = tree.poses(middle);
        let at = move |i: usize| self.scene_from_base.after(&parts[i].pose(&poses));
        let of_all = |i: usize| std::iter::once(None).chain((0..i).map(Some)).map(move |j| (j, i));
        let may_touch = |&(j, i): &Pair| {
            let other = j.map_or(SURROUNDINGS, |j| &*parts[j].name);
            self.scene.is_allowed(&parts[i].name, other) != Ok(true)
        };
        let ends = ends.map(<[f64]>::to_vec);
        // What carries both changes nothing between them.
        let way = move |i: usize, beside: Option<usize>| {
            let carries = |joint: usize, j: usize| tree.chain(parts[j].link).any(|k| k == joint);
            let is_common = |joint: usize| beside.is_some_and(|j| carries(joint, j));
            farthest(tree, (parts[i].link, parts[i].radius), [&ends[0], &ends[1]], is_common)
        };
        let at_most = move |(j, i): Pair| {
            let (a_from_b, way) = match j {
                Some(j) => (at(j).inverse().after(&at(i)), way(i, Some(j)) + way(j, Some(i))),
                None => (at(i), way(i, None)),
            };
            let a: Result<BodyRef<'_>, _> = match j {
                Some(j) => Ok((&*parts[j].body).into()),
                None => self.scene.body(SURROUNDINGS).map(Into::into),
            };
            // What cannot be asked is not clear.
            let found = a.ok().and_then(|a| query.within(a, &*parts[i].body, &a_from_b, way).ok());
            found.map_or(1.0, |(_, within)| within.bounds[1])
        };
        (0..parts.len()).flat_map(of_all).filter(may_touch).map(move |pair| (pair, at_most(pair)))
    }

    fn nearest(&self, (a, b): Pair, at_most: f64) -> Nearest {
        let a = a.map_or(SURROUNDINGS, |a| &*self.carried[a].name);
        Nearest { a: a.to_owned(), b: self.carried[b].name.clone(), at_most }
    }
}

/// A part or the surroundings, and another part.
type Pair = (Option<usize>, usize);

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

fn between(from: &[f64], to: &[f64], time: f64) -> Vec<f64> {
    from.iter().zip(to).map(|(from, to)| from + (to - from) * time).collect()
}

/// No point of what a link carries within a radius (m) is farther than this from where it is in the middle of a
/// motion, m, seen from the outermost joint that `is_common` with what it is seen from: every joint that carries it
/// on takes it along by no more than half its turn times its longest lever.
fn farthest(
    tree: &Tree,
    (link, radius): (usize, f64),
    [from, to]: [&[f64]; 2],
    is_common: impl Fn(usize) -> bool,
) -> f64 {
    let (mut lever, mut way) = (radius, 0.0);
    for joint in tree.chain(link).take_while(|&joint| !is_common(joint)) {
        let (from, to) = (from[joint], to[joint]);
        let half = 0.5 * (to - from).abs();
        let of = &tree.joints[joint];
        let slides = of.kind == JointKind::Prismatic;
        way += half * if slides { 1.0 } else { lever };
        lever +=
            of.origin.translation().norm() + if slides { from.abs().max(to.abs()) } else { 0.0 };
    }
    // Rounding.
    way * (1.0 + 1e-9)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::robot::Robot;

    const URDF: &str = "<robot name='r'><link name='a'/><link name='b'/><link name='c'/><link name='d'>
        <collision><origin xyz='0.1 0.2 0'/><geometry><box size='0.5 0.1 0.2'/></geometry></collision></link>
        <joint name='p' type='revolute'><parent link='a'/><child link='b'/><origin xyz='0.2 0 0.3' rpy='1 0 0'/>
          <axis xyz='1 0 1'/><limit lower='-3' upper='3' effort='1' velocity='1'/></joint>
        <joint name='q' type='prismatic'><parent link='b'/><child link='c'/><origin xyz='0 0.4 0' rpy='0 1 0'/>
          <axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='1' velocity='1'/></joint>
        <joint name='r' type='continuous'><parent link='c'/><child link='d'/><origin xyz='0 0 0.3'/>
          <axis xyz='0 1 0'/></joint></robot>";

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// No corner gets farther from its place in the middle than is said, and long motions are
        /// bounded within a factor of five.
        #[test]
        fn no_corner_goes_farther_than_its_bound(
            from in prop::array::uniform3(-1.0..1.0_f64), to in prop::array::uniform3(-1.0..1.0_f64),
            times in prop::collection::vec(0.0..=1.0_f64, 20),
        ) {
            let folder = tempfile::tempdir().unwrap();
            let file = folder.path().join("r.urdf");
            std::fs::write(&file, URDF).unwrap();
            let Robot { tree, shapes, .. } = Robot::from_urdf(file, &[]).unwrap();
            // Seen from the base, and from what the first joint carries.
            for common in [0, 1] {
                let is_common = |joint| joint < common;
                let bound = farthest(&tree, (shapes[0].link, shapes[0].radius), [&from, &to], is_common);
                let pose = |time| {
                    let poses = tree.poses(&between(&from, &to, time));
                    let seen_from = if common == 0 { 0 } else { tree.joints[0].child };
                    poses[seen_from].inverse().after(&poses[shapes[0].link])
                };
                let (middle, mut most) = (pose(0.5), 0.0_f64);
                for &time in times.iter().chain(&[0.0, 1.0]) {
                    for p in shapes[0].triangles.vertices() {
                        let way = (pose(time).transform_point(p) - middle.transform_point(p)).norm();
                        prop_assert!(way <= bound, "{} beyond {}", way, bound);
                        most = most.max(way);
                    }
                }
                let moves_much = from.iter().zip(&to).all(|(from, to)| to - from > 0.5);
                prop_assert!(!moves_much || bound < 5.0 * most, "{} against {}", bound, most);
            }
        }
    }
}
