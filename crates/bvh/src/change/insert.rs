//! Insertion into the leaf whose box, and whose ancestors' boxes, grow least.

use crate::tree::node::Link;
use crate::{Obb, Primitive, Tree, TreeError};

impl Tree {
    /// Adds a primitive and returns its index, the next one never used.
    ///
    /// Boxes on the way down grow to hold it; a leaf that comes to hold too much is split. Costs
    /// the depth of the tree, and one pass over the index arrays to make room. The boxes passed
    /// stay loose until [`Self::tighten`] or [`Self::rebuild`].
    ///
    /// # Errors
    /// When a coordinate, the covariance or the weight is not a usable number; the tree is then
    /// unchanged.
    pub fn insert(&mut self, primitive: Primitive) -> Result<usize, TreeError> {
        let index = self.primitives.len();
        primitive.check(index)?;
        if index >= u32::MAX as usize - 1 {
            return Err(TreeError::TooMany { count: index + 1 });
        }
        self.primitives.push(primitive);
        self.leaf_of.push(Link::NONE);
        let Some(root) = self.root else {
            self.order.push(index as u32);
            self.rebuild();
            return Ok(index);
        };
        let leaf = self.leaf_of_least_growth(root, &primitive);
        self.leaf_of[index] = Link::from(leaf);
        self.make_room(leaf, index as u32);
        for id in self.path_up(leaf) {
            self.nodes[id as usize].resize(|obb| include(obb, &primitive));
        }
        self.update_up(leaf);
        if self.should_split(leaf) {
            self.subdivide(leaf);
            self.update_up(leaf);
        }
        Ok(index)
    }

    /// Goes down to the child whose squared diagonal grows least, the smaller one if equal.
    pub(crate) fn leaf_of_least_growth(&self, root: u32, primitive: &Primitive) -> u32 {
        let cost = |id: u32| {
            let obb = self.nodes[id as usize].obb.unpacked();
            let mut grown = obb;
            include(&mut grown, primitive);
            let before = obb.half_extents.norm_squared();
            (grown.half_extents.norm_squared() - before, before)
        };
        let mut id = root;
        while let Some([left, right]) = self.nodes[id as usize].children() {
            let ((left_growth, left_size), (right_growth, right_size)) = (cost(left), cost(right));
            let by_growth = left_growth.total_cmp(&right_growth);
            id =
                if by_growth.then(left_size.total_cmp(&right_size)).is_le() { left } else { right };
        }
        id
    }

    /// Appends an index to the range of a leaf, and moves the ranges behind it.
    fn make_room(&mut self, leaf: u32, index: u32) {
        let node = &self.nodes[leaf as usize];
        let position = node.start + node.count;
        self.order.insert(position as usize, index);
        for node in &mut self.nodes {
            if node.start >= position {
                node.start += 1;
            }
        }
        // The leaf and its ancestors begin before `position`, so only their length changes.
        for id in self.path_up(leaf) {
            self.nodes[id as usize].count += 1;
        }
    }
}

pub(crate) fn include(obb: &mut Obb, primitive: &Primitive) {
    for corner in primitive.corners() {
        obb.include(corner);
    }
}
