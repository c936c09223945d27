//! Checks every rule a tree must keep; for tests and for hunting defects.

use cloudtouch_geom::Matrix3;

use crate::tree::bounds::SpreadBounds;
use crate::tree::coverage::fraction_outside;
use crate::tree::node::Link;
use crate::{Tree, TreeError};

/// Relative rounding allowed where a rule compares sums computed in different order.
const ROUNDING: f64 = 1e-9;

impl Tree {
    /// Checks that every primitive is in exactly one leaf, that ranges, links and indices agree,
    /// that boxes hold their corners, that coverages kept are right, and that the bounds of a
    /// parent cover those of its children and its points. O(n log n).
    ///
    /// # Errors
    /// [`TreeError::Malformed`] with the first broken rule. A tree that went only through the
    /// public functions never gives one.
    pub fn validate(&self) -> Result<(), TreeError> {
        let nodes = self.preorder(self.root);
        let in_use = self.nodes.iter().filter(|node| node.count > 0).count();
        self.require(0, nodes.len() == in_use, "nodes in use and reachable nodes differ")?;
        self.require(
            0,
            self.free.len() + in_use == self.nodes.len(),
            "a slot is neither in use nor free",
        )?;
        let mut seen = vec![false; self.primitives.len()];
        for &index in &self.order {
            let twice = std::mem::replace(&mut seen[index as usize], true);
            self.require(0, !twice, "a primitive is listed twice")?;
        }
        for (index, leaf) in self.leaf_of.iter().enumerate() {
            self.require(
                0,
                leaf.get().is_some() == seen[index],
                "a present primitive is not listed",
            )?;
        }
        if let Some(root) = self.root {
            let node = &self.nodes[root as usize];
            self.require(root, node.parent == Link::NONE, "the root has a parent")?;
            let everything = node.start == 0 && node.count as usize == self.order.len();
            self.require(root, everything, "the root does not span all primitives")?;
        } else {
            self.require(0, self.order.is_empty(), "primitives without a root")?;
        }
        for id in nodes {
            self.validate_links(id)?;
            self.validate_shape(id)?;
            self.validate_bounds(id)?;
        }
        Ok(())
    }

    fn require(&self, id: u32, holds: bool, reason: &'static str) -> Result<(), TreeError> {
        if holds { Ok(()) } else { Err(TreeError::Malformed { node: id as usize, reason }) }
    }

    fn validate_links(&self, id: u32) -> Result<(), TreeError> {
        let node = &self.nodes[id as usize];
        self.require(id, node.count > 0, "an empty or released node is reachable")?;
        let Some([left, right]) = node.children() else {
            let small = node.count as usize <= self.settings.max_leaf_points;
            self.require(id, small, "a leaf holds more than max_leaf_points")?;
            let named =
                self.indices_of(id).iter().all(|&i| self.leaf_of[i as usize] == Link::from(id));
            return self.require(id, named, "leaf_of names another leaf");
        };
        let (first, second) = (&self.nodes[left as usize], &self.nodes[right as usize]);
        let linked = first.parent == Link::from(id) && second.parent == Link::from(id);
        self.require(id, linked, "a child names another parent")?;
        let halves = first.start == node.start
            && first.start + first.count == second.start
            && first.count + second.count == node.count;
        self.require(id, halves, "the ranges of the children do not make up that of the node")
    }

    fn validate_shape(&self, id: u32) -> Result<(), TreeError> {
        let obb = self.nodes[id as usize].obb.unpacked();
        let unit = (obb.axes.tr_mul(&obb.axes) - Matrix3::identity()).amax() < ROUNDING;
        self.require(id, unit, "the box axes are not orthonormal")?;
        for &index in self.indices_of(id) {
            let corners = self.primitives.corners(index);
            let inside = corners.iter().all(|corner| obb.contains(corner));
            self.require(id, inside, "a corner lies outside the box")?;
        }
        let below = self.indices_of(id).iter().map(|&i| self.primitives.get(i));
        let kept =
            self.coverages.known(id).is_none_or(|kept| kept == fraction_outside(below, &obb));
        self.require(id, kept, "the coverage kept is that of other points")
    }

    fn validate_bounds(&self, id: u32) -> Result<(), TreeError> {
        let node = &self.nodes[id as usize];
        let (axes, bounds) = (&node.obb.axes, node.bounds.unpacked());
        for &index in self.indices_of(id) {
            let covered = covers(&bounds, &self.bounds_of_primitive(index, axes));
            self.require(id, covered, "a primitive exceeds the bounds of its node")?;
        }
        let from_children = node.children().filter(|_| self.extents.is_empty());
        for child in from_children.into_iter().flatten() {
            let child = &self.nodes[child as usize];
            let turned = child.bounds.unpacked().turned(&child.obb.axes, axes);
            self.require(id, covers(&bounds, &turned), "a child exceeds its parent's bounds")?;
        }
        Ok(())
    }
}

fn covers(outer: &SpreadBounds, inner: &SpreadBounds) -> bool {
    let enough = |outer: f64, inner: f64| outer >= inner * (1.0 - ROUNDING);
    enough(outer.max_std, inner.max_std)
        && enough(outer.shift, inner.shift)
        && enough(outer.max_reach, inner.max_reach)
        && (0..3).all(|k| enough(outer.axis_std[k], inner.axis_std[k]))
        && (0..3).all(|k| enough(outer.axis_reach[k], inner.axis_reach[k]))
}
