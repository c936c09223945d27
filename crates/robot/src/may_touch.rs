//! Which links may touch.

use std::collections::BTreeSet;

use crate::joint::JointKind;
use crate::link::Shape;
use crate::tree::Tree;

/// Pairs of links that may touch, by their names in order.
#[derive(Debug, Clone, Default)]
pub(crate) struct MayTouch(BTreeSet<[String; 2]>);

impl MayTouch {
    /// Those between which no joint moves, and each with the next that has geometry on the way to the base.
    pub(crate) fn of_neighbors(tree: &Tree, shapes: &[Shape]) -> Self {
        let mut pairs = Self::default();
        let solid: BTreeSet<usize> = shapes.iter().map(|shape| shape.link).collect();
        let groups = rigid_groups(tree);
        for &link in &solid {
            let with_it =
                solid.iter().filter(|&&other| other < link && groups[other] == groups[link]);
            // Flanges between have no geometry.
            let carriers = tree.chain(link).map(|joint| tree.joints[joint].parent);
            let next = carriers.into_iter().find(|carrier| solid.contains(carrier));
            for other in with_it.copied().chain(next) {
                pairs.add(tree.links[link].clone(), tree.links[other].clone());
            }
        }
        pairs
    }

    pub(crate) fn add(&mut self, a: String, b: String) {
        self.0.insert(in_order(a, b));
    }

    pub(crate) fn has(&self, a: &str, b: &str) -> bool {
        self.0.contains(&in_order(a.to_owned(), b.to_owned()))
    }
}

/// For each link a link that it never moves against, the same for all of them.
fn rigid_groups(tree: &Tree) -> Vec<usize> {
    let mut groups: Vec<usize> = (0..tree.links.len()).collect();
    for joint in tree.joints.iter().filter(|joint| joint.kind == JointKind::Fixed) {
        groups[joint.child] = groups[joint.parent];
    }
    groups
}

fn in_order(a: String, b: String) -> [String; 2] {
    let mut pair = [a, b];
    pair.sort();
    pair
}
