//! Patches: many primitives come, go and change at once, and only the leaves that hold them are made
//! anew.

use std::collections::BTreeMap;

use cloudtouch_geom::Covariance;

use crate::change::insert::include;
use crate::tree::node::{Link, NodeData};
use crate::tree::primitive::check_extent;
use crate::{LeafBounds, Node, NodeId, Primitive, Tree, TreeError};

/// A primitive that is gone.
const GONE: u32 = u32::MAX;

/// What a patch did to the nodes of a tree.
#[derive(Debug, Default)]
pub struct Patched {
    /// Nodes that were leaves and hold other primitives now, are split, or are gone.
    pub stale: Vec<NodeId>,
    /// Leaves that hold other primitives than before, some under names of nodes that are gone.
    pub leaves: Vec<NodeId>,
}

impl Tree {
    /// Gives the tree other primitives, most of which it has: `before` says of each, by its index from
    /// now on, which index it had, and those that had none are `added` in order. What is named nowhere
    /// is gone. The tree must have all indices it ever gave out ([`Self::remove`] was never called).
    ///
    /// Leaves that lose or gain primitives are fitted anew, split or dropped; boxes and bounds above them
    /// grow to hold what came, and shrink at the next [`Self::rebuild`]. So answers stay right, and
    /// searches slow down by and by: watch how much was changed, and [`Self::quality`]. Bounds and extents stay
    /// with the primitives; what is added has none, and its own covariance until they are set. Takes one
    /// pass over the lists of indices, and the depth of the tree for each primitive that changes.
    ///
    /// # Errors
    /// When a coordinate, covariance or weight of one that is added is not a usable number, an index is
    /// named twice or was never given out, their number is not that of the indices without one,
    /// none would be left, or ([`TreeError::Count`] too) a primitive was removed before; the tree is then unchanged.
    pub fn patch(
        &mut self,
        before: &[Option<u32>],
        added: &[Primitive],
    ) -> Result<Patched, TreeError> {
        let new = (0..).zip(before).filter(|(_, before)| before.is_none()).map(|(index, _)| index);
        let new: Vec<u32> = new.collect();
        if new.len() != added.len() || self.order.len() != self.primitives.len() {
            let (expected, found) = (new.len(), added.len());
            return Err(TreeError::Count { expected, found });
        }
        for (index, primitive) in new.iter().zip(added) {
            primitive.check(*index as usize)?;
        }
        let after = self.after(before)?;
        let Some(root) = self.root.filter(|_| !before.is_empty()) else {
            return Err(TreeError::Count { expected: 1, found: 0 });
        };
        let mut changed = self.renumber(before, &after, &new, added);
        for &index in &new {
            let leaf = self.leaf_of_least_growth(root, &self.primitives.get(index));
            self.leaf_of[index as usize] = Link::from(leaf);
            changed.entry(leaf).or_default().push(index);
            self.raise(index);
        }
        self.relay(&after, &changed);
        let stale = changed.keys().map(|&leaf| NodeId(leaf)).collect();
        let mut leaves = Vec::new();
        for &leaf in changed.keys() {
            if self.nodes[leaf as usize].count == 0 {
                // What moves up is seen from the node above along other axes than through the one that went.
                let above = self.detach(leaf).and_then(|id| self.nodes[id as usize].children());
                above.into_iter().flatten().for_each(|child| self.raise_above(child));
                continue;
            }
            self.fit_leaf(leaf);
            if self.should_split(leaf) {
                self.subdivide(leaf);
            }
            self.raise_above(leaf);
            let below = self.preorder(Some(leaf)).into_iter();
            leaves.extend(below.filter(|&id| self.nodes[id as usize].is_leaf()));
        }
        self.coverages.forget();
        Ok(Patched { stale, leaves: leaves.into_iter().map(NodeId).collect() })
    }

    /// Replaces primitives, each with how far its surface reaches, by their indices: their leaves are
    /// fitted anew, and boxes and bounds above them grow. Only for trees whose extents are
    /// [set](Self::set_extents).
    ///
    /// # Errors
    /// When a number is not usable, or there is no such index; the tree is then unchanged.
    pub fn amend(&mut self, amended: &[(u32, Primitive, Covariance)]) -> Result<(), TreeError> {
        for (index, primitive, extent) in amended {
            primitive.check(*index as usize)?;
            check_extent(extent, *index as usize)?;
            if self.extents.len() <= *index as usize || self.leaf_of(*index as usize).is_none() {
                return Err(TreeError::NoSuchPrimitive { index: *index as usize });
            }
        }
        let mut leaves = Vec::new();
        for (index, primitive, extent) in amended {
            self.primitives.set(*index, *primitive);
            self.extents[*index as usize] = *extent;
            self.raise(*index);
            leaves.extend(self.leaf_of[*index as usize].get());
        }
        leaves.sort_unstable();
        leaves.dedup();
        leaves.iter().for_each(|&leaf| self.fit_leaf(leaf));
        self.coverages.forget();
        Ok(())
    }

    /// [`Self::set_leaf_bounds`] of these leaves alone; bounds above them grow.
    ///
    /// # Errors
    /// As [`Self::set_leaf_bounds`]; the tree is then unchanged.
    pub fn set_bounds_of(
        &mut self,
        leaves: &[NodeId],
        mut bounds_of: impl FnMut(Node<'_>) -> LeafBounds,
    ) -> Result<(), TreeError> {
        let mut all = Vec::new();
        for leaf in leaves.iter().filter_map(|&id| self.leaf(id)) {
            let bounds = bounds_of(leaf);
            bounds.check(leaf.id().index())?;
            all.push((leaf.id().0, bounds));
        }
        let count = self.primitives.len();
        for (leaf, bounds) in all {
            let indices = self.indices_of(leaf).to_vec();
            self.refined.set(&indices, bounds, count);
            // All primitives of the leaf bring the same, in every direction: so do they above it.
            self.set_bounds(leaf);
            let of_leaf = self.nodes[leaf as usize].bounds.unpacked();
            for id in self.path_up(leaf) {
                self.nodes[id as usize].raise(&of_leaf);
            }
            self.raise_above(leaf);
        }
        Ok(())
    }

    /// The index that each primitive gets.
    fn after(&self, before: &[Option<u32>]) -> Result<Vec<u32>, TreeError> {
        let mut after = vec![GONE; self.primitives.len()];
        for (index, before) in (0..).zip(before) {
            let Some(before) = *before else { continue };
            match after.get_mut(before as usize) {
                Some(slot) if *slot == GONE => *slot = index,
                _ => return Err(TreeError::NoSuchPrimitive { index: before as usize }),
            }
        }
        Ok(after)
    }

    /// Moves what is kept by index to the new ones, and says which leaves lose something.
    fn renumber(
        &mut self,
        before: &[Option<u32>],
        after: &[u32],
        new: &[u32],
        added: &[Primitive],
    ) -> BTreeMap<u32, Vec<u32>> {
        fn of<T: Copy>(kept: &[T], before: &[Option<u32>], fresh: T) -> Vec<T> {
            let one = |index: &Option<u32>| index.and_then(|i| kept.get(i as usize).copied());
            before.iter().map(|index| one(index).unwrap_or(fresh)).collect()
        }
        let gone = after.iter().zip(&self.leaf_of).filter(|(after, _)| **after == GONE);
        let changed = gone.filter_map(|(_, leaf)| Some((leaf.get()?, Vec::new()))).collect();
        self.primitives.renumber(before);
        for (&index, primitive) in new.iter().zip(added) {
            self.primitives.set(index, *primitive);
        }
        self.leaf_of = of(&self.leaf_of, before, Link::NONE);
        self.refined.renumber(before);
        if !self.extents.is_empty() {
            self.extents = of(&self.extents, before, Covariance::zero());
        }
        changed
    }

    /// Lists the indices of all leaves anew, with what came to some of them.
    fn relay(&mut self, after: &[u32], changed: &BTreeMap<u32, Vec<u32>>) {
        let nodes = self.preorder(self.root);
        let mut order = Vec::with_capacity(self.primitives.len());
        for &id in &nodes {
            let start = order.len();
            if self.nodes[id as usize].is_leaf() {
                let kept = self.indices_of(id).iter().map(|&index| after[index as usize]);
                order.extend(kept.filter(|&index| index != GONE));
                order.extend(changed.get(&id).into_iter().flatten());
            }
            let node = &mut self.nodes[id as usize];
            (node.start, node.count) = (start as u32, (order.len() - start) as u32);
        }
        for &id in nodes.iter().rev() {
            if let Some(children) = self.nodes[id as usize].children() {
                let counts = children.map(|child| self.nodes[child as usize].count);
                self.nodes[id as usize].count = counts.iter().sum();
            }
        }
        self.order = order;
    }

    /// Lets boxes and bounds of all nodes around a primitive hold it.
    fn raise(&mut self, index: u32) {
        let primitive = self.primitives.get(index);
        let mut next = self.leaf_of[index as usize];
        while let Some(id) = next.get() {
            let bounds = self.bounds_of_primitive(index, &self.nodes[id as usize].obb.axes);
            let node = &mut self.nodes[id as usize];
            node.resize(|obb| include(obb, &primitive));
            node.raise(&bounds);
            next = node.parent;
        }
    }

    /// Lets the bounds of all nodes above a leaf, or one just split, hold its own along its axes now.
    fn raise_above(&mut self, mut id: u32) {
        // With extents they are taken from the primitives.
        while self.extents.is_empty()
            && let Some(parent) = self.nodes[id as usize].parent.get()
        {
            let NodeData { obb, bounds, .. } = &self.nodes[id as usize];
            let turned = bounds.unpacked().turned(&obb.axes, &self.nodes[parent as usize].obb.axes);
            self.nodes[parent as usize].raise(&turned);
            id = parent;
        }
    }

    fn fit_leaf(&mut self, leaf: u32) {
        self.fit(leaf);
        self.set_bounds(leaf);
    }
}
