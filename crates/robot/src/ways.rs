//! How far what a link carries gets on a stretch of a path of joints.

use crate::joint::JointKind;
use crate::tree::Tree;

/// No point of what a link carries within a radius (m) is farther than this from where it is in the middle of a
/// motion, m, seen from each link in the order of the tree: every joint that carries it on, but not what it is seen
/// from too, takes it along by no more than half its turn times its longest lever.
///
/// PERF: of all links at once, for of the pairs of a hundred links one after the other it took longer than all that
/// is asked about them.
pub(crate) fn ways(tree: &Tree, (link, radius): (usize, f64), [from, to]: [&[f64]; 2]) -> Vec<f64> {
    let (mut lever, mut way) = (radius, 0.0);
    // Of each joint that carries it what those further out add up to.
    let mut further_out = vec![None; tree.joints.len()];
    for joint in tree.chain(link) {
        further_out[joint] = Some(way);
        let (from, to) = (from[joint], to[joint]);
        let half = 0.5 * (to - from).abs();
        let of = &tree.joints[joint];
        let slides = of.kind == JointKind::Prismatic;
        way += half * if slides { 1.0 } else { lever };
        lever +=
            of.origin.translation().norm() + if slides { from.abs().max(to.abs()) } else { 0.0 };
    }
    // From the base on, what carries both changes nothing between them.
    let mut ways = vec![way; tree.links.len()];
    for (of, further_out) in tree.joints.iter().zip(further_out) {
        ways[of.child] = further_out.unwrap_or(ways[of.parent]);
    }
    // Rounding.
    ways.into_iter().map(|way| way * (1.0 + 1e-9)).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::robot::Robot;
    use crate::stretch::between;

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
            for seen_from in [0, tree.joints[0].child] {
                let bound = ways(&tree, (shapes[0].link, shapes[0].radius), [&from, &to])[seen_from];
                let pose = |time| {
                    let poses = tree.poses(&between(&from, &to, time));
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

        /// Joint by joint, as far as one carries the other too: the same bits.
        #[test]
        fn seen_from_all_links_at_once_is_as_from_one_after_the_other(
            parents in prop::collection::vec(0..8_usize, 8), slide in prop::bool::ANY,
            from in prop::array::uniform8(-1.0..1.0_f64), to in prop::array::uniform8(-1.0..1.0_f64),
        ) {
            let tree = tree_of(&parents, slide);
            for link in 0..tree.links.len() {
                let found = ways(&tree, (link, 0.3), [&from, &to]);
                for beside in 0..tree.links.len() {
                    let slowly = seen_from((&tree, beside), (link, 0.3), [&from, &to]);
                    prop_assert_eq!(found[beside].to_bits(), slowly.to_bits(), "{} from {}", link, beside);
                }
            }
        }
    }

    /// Links that each hang on one before them.
    fn tree_of(parents: &[usize], slide: bool) -> Tree {
        let links: String = (0..=parents.len()).map(|i| format!("<link name='l{i}'/>")).collect();
        let joint = |(i, parent): (usize, &usize)| {
            let (child, kind) = (i + 1, if slide && i % 2 == 0 { "prismatic" } else { "revolute" });
            format!(
                "<joint name='j{child}' type='{kind}'><parent link='l{}'/><child link='l{child}'/>\
                 <origin xyz='0.1 {i} 0'/><limit lower='-2' upper='2' effort='1' velocity='1'/></joint>",
                parent % child
            )
        };
        let joints: String = parents.iter().enumerate().map(joint).collect();
        let urdf = format!("<robot name='r'>{links}{joints}</robot>");
        Tree::try_from_urdf(&urdf_rs::read_from_string(&urdf).unwrap()).unwrap()
    }

    fn seen_from(
        (tree, beside): (&Tree, usize),
        (link, radius): (usize, f64),
        [from, to]: [&[f64]; 2],
    ) -> f64 {
        let is_common = |joint: usize| tree.chain(beside).any(|other| other == joint);
        let (mut lever, mut way) = (radius, 0.0);
        for joint in tree.chain(link).take_while(|&joint| !is_common(joint)) {
            let (of, half) = (&tree.joints[joint], 0.5 * (to[joint] - from[joint]).abs());
            let slides = of.kind == JointKind::Prismatic;
            way += half * if slides { 1.0 } else { lever };
            let slid = from[joint].abs().max(to[joint].abs());
            lever += of.origin.translation().norm() + if slides { slid } else { 0.0 };
        }
        way * (1.0 + 1e-9)
    }
}
