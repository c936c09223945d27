//! A stretch of a path of joints: how far a robot gets from its place in the middle, and what it may meet
//! there.

use cloudtouch::geom::Pose;
use cloudtouch::{Body, BodyRef, Query};

use crate::carried::{Ball, Carried};
use crate::checker::{RobotChecker, SURROUNDINGS};
use crate::ways::ways;

/// A part or the surroundings, and another part.
pub(crate) type Pair = (Option<usize>, usize);

impl RobotChecker {
    /// Of every pair that may touch the largest probability that it meets on the way from one position to the
    /// other, of which `middle` is the middle and reads as free. Pairs whose probability is known to be 0 are left
    /// out.
    pub(crate) fn around<'a>(
        &'a self,
        query: &Query,
        middle: &[f64],
        ends: [&[f64]; 2],
    ) -> impl Iterator<Item = (Pair, f64)> + use<'a> {
        let (stretch, query) = (Stretch::new(self, middle, ends), query.among_many());
        let of_all = |i: usize| std::iter::once(None).chain((0..i).map(Some)).map(move |j| (j, i));
        let at_most = move |pair: Pair| {
            // PERF: most links of many are far from most.
            let is_asked = !stretch.is_clear(pair) && self.may_touch(pair);
            is_asked.then(|| (pair, stretch.at_most(&query, pair)))
        };
        (0..self.carried.len()).flat_map(of_all).filter_map(at_most)
    }

    fn may_touch(&self, (j, i): Pair) -> bool {
        let other = j.map_or(SURROUNDINGS, |j| &*self.carried[j].name);
        self.scene.is_allowed(&self.carried[i].name, other) != Ok(true)
    }
}

/// A robot on a stretch of its path.
struct Stretch<'a> {
    checker: &'a RobotChecker,
    /// Where each part is in the middle, into the frame of the surroundings.
    at: Vec<Pose>,
    /// About it there; of meshes alone.
    balls: Vec<Option<Ball>>,
    /// How far it gets from there, m, seen from each link.
    ways: Vec<Vec<f64>>,
}

impl<'a> Stretch<'a> {
    fn new(checker: &'a RobotChecker, middle: &[f64], ends: [&[f64]; 2]) -> Self {
        let (tree, parts) = (&checker.robot.tree, &checker.carried);
        let poses = tree.poses(middle);
        let pose = |part: &Carried| checker.scene_from_base.after(&part.pose(&poses));
        let at: Vec<Pose> = parts.iter().map(pose).collect();
        let balls = parts.iter().zip(&at).map(|(part, at)| part.ball(at)).collect();
        let way = |part: &Carried| ways(tree, (part.link, part.radius), ends);
        Self { checker, at, balls, ways: parts.iter().map(way).collect() }
    }

    /// How far the two of a pair get against each other, m.
    fn way(&self, (j, i): Pair) -> f64 {
        let link = |part: usize| self.checker.carried[part].link;
        match j {
            Some(j) => self.ways[i][link(j)] + self.ways[j][link(i)],
            None => self.ways[i][self.checker.robot.tree.root()],
        }
    }

    /// Whether two exact parts do not meet, whatever is found of them: that they read as free in the middle says that
    /// nothing else speaks against it.
    fn is_clear(&self, pair: Pair) -> bool {
        let (Some(j), i) = pair else { return false };
        let (Some(a), Some(b)) = (&self.balls[j], &self.balls[i]) else { return false };
        a.is_beyond(b, self.way(pair))
    }

    /// The largest probability that the two of a pair meet.
    fn at_most(&self, query: &Query, pair: Pair) -> f64 {
        let (at, parts, way) = (&self.at, &self.checker.carried, self.way(pair));
        let (j, i) = pair;
        let b = &*parts[i].body;
        let found = match j.map(|j| (j, &*parts[j].body)) {
            Some((j, a)) if is_larger_mesh(b, a) => {
                query.bound_around(b, a, &at[i].inverse().after(&at[j]), way).ok()
            }
            Some((j, a)) => query.bound_around(a, b, &at[j].inverse().after(&at[i]), way).ok(),
            None => {
                let a = self.checker.scene.body(SURROUNDINGS).ok();
                a.and_then(|a| query.bound_around(&**a, b, &at[i], way).ok())
            }
        };
        // What cannot be asked is not clear.
        found.unwrap_or(1.0)
    }
}

/// Whether a mesh is larger than another, and has to be asked about as the first of the two: how near they come either
/// tells, of clouds not, which turn against what keeps still.
fn is_larger_mesh(mesh: &Body, other: &Body) -> bool {
    let size = |body: &Body| {
        let [low, high] = BodyRef::from(body).corners();
        (high - low).norm()
    };
    let are_meshes = matches!((mesh, other), (Body::Mesh(_), Body::Mesh(_)));
    are_meshes && size(mesh) > size(other)
}

/// The position at a time from 0 to 1 on the way from one to another.
pub(crate) fn between(from: &[f64], to: &[f64], time: f64) -> Vec<f64> {
    from.iter().zip(to).map(|(from, to)| from + (to - from) * time).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::LazyLock;

    use cloudtouch::QuerySettings;
    use cloudtouch_testkit::scene::cuboid;
    use proptest::prelude::*;

    use super::*;
    use crate::Touching;
    use crate::robot::Robot;

    /// Eight links, each on the one before, of sizes that differ; far away a wall.
    fn checker() -> RobotChecker {
        let link = |i: usize| {
            let size = 0.02 * (1 + i % 3) as f64;
            format!(
                "<link name='l{i}'><collision><origin xyz='0 {size} 0.05' rpy='0.{i} 0 1'/><geometry>\
                 <box size='{size} 0.03 0.06'/></geometry></collision></link>"
            )
        };
        let joint = |i: usize| {
            let axis = ["1 0 0", "0 1 0", "1 1 1"][i % 3];
            format!(
                "<joint name='j{i}' type='continuous'><parent link='l{}'/><child link='l{i}'/>\
                 <origin xyz='0 0 0.1'/><axis xyz='{axis}'/></joint>",
                i - 1
            )
        };
        let urdf: String = (0..8).map(link).chain((1..8).map(joint)).collect();
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("r.urdf");
        std::fs::write(&file, format!("<robot name='r'>{urdf}</robot>")).unwrap();
        let wall = cloudtouch::Mesh::prepare(&cuboid([0.1, 2.0, 2.0])).unwrap();
        let at = Pose::from_translation([5.0, 0.1, -0.2].into());
        let robot = Robot::from_urdf(file, &[]).unwrap();
        RobotChecker::new(robot, Body::from(wall), at, Touching::AndItself).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 500, ..ProptestConfig::default() })]

        /// Every pair that is left out has the probability 0 where it is asked about, to the bit.
        #[test]
        fn what_is_left_out_is_known_not_to_meet(
            middle in prop::array::uniform7(-3.0..3.0_f64), turns in prop::array::uniform7(-1.0..1.0_f64),
            share in 0.0..0.2_f64,
        ) {
            static CHECKER: LazyLock<RobotChecker> = LazyLock::new(checker);
            let (checker, query) = (&*CHECKER, Query::new(QuerySettings::default()).unwrap());
            let joints: BTreeMap<String, f64> =
                (1..8).map(|i| format!("j{i}")).zip(middle).collect();
            prop_assume!(checker.check(&query, &joints).unwrap().pairs.is_empty());
            let end = |sign: f64| -> Vec<f64> {
                middle.iter().zip(&turns).map(|(at, turn)| at + sign * share * turn).collect()
            };
            let ends = [end(-1.0), end(1.0)];
            let stretch = Stretch::new(checker, &middle, [&ends[0], &ends[1]]);
            let query = query.among_many();
            for i in 0..8 {
                for j in 0..i {
                    let (pair, found) = ((Some(j), i), stretch.at_most(&query, (Some(j), i)));
                    prop_assert!(!stretch.is_clear(pair) || found.to_bits() == 0, "{pair:?} {found}");
                }
            }
        }
    }

    /// Of links in a row all but the nearest few.
    #[test]
    fn most_links_of_a_row_are_left_out() {
        let checker = checker();
        let query = Query::new(QuerySettings::default()).unwrap();
        let ends = [[-0.01; 7], [0.01; 7]];
        let asked = checker.around(&query, &[0.0; 7], [&ends[0], &ends[1]]);
        // With the wall they are asked about all the same.
        assert!(asked.filter(|((j, _), _)| j.is_some()).count() < 12);
    }
}
