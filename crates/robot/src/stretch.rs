//! A stretch of a path of joints: how far a robot gets from its place in the middle, and what it may meet
//! there.

use cloudtouch::{Body, BodyRef, Query};

use crate::checker::{RobotChecker, SURROUNDINGS};
use crate::joint::JointKind;
use crate::tree::Tree;

/// A part or the surroundings, and another part.
pub(crate) type Pair = (Option<usize>, usize);

impl RobotChecker {
    /// Of every pair that may touch the largest probability that it meets on the way from one position to the
    /// other, of which `middle` is the middle: of the surroundings (`None`) or a part, and another part.
    pub(crate) fn around<'a>(
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
        let query = query.among_many();
        let at_most = move |(j, i): Pair| {
            let b = &*parts[i].body;
            let found = match j.map(|j| (j, &*parts[j].body)) {
                Some((j, a)) => {
                    let way = way(i, Some(j)) + way(j, Some(i));
                    let bound = |a, b, a_from_b| query.bound_around(a, b, &a_from_b, way).ok();
                    match is_larger_mesh(b, a) {
                        true => bound(b, a, at(i).inverse().after(&at(j))),
                        false => bound(a, b, at(j).inverse().after(&at(i))),
                    }
                }
                None => {
                    let a = self.scene.body(SURROUNDINGS).ok();
                    a.and_then(|a| query.bound_around(&**a, b, &at(i), way(i, None)).ok())
                }
            };
            // What cannot be asked is not clear.
            found.unwrap_or(1.0)
        };
        (0..parts.len()).flat_map(of_all).filter(may_touch).map(move |pair| (pair, at_most(pair)))
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
