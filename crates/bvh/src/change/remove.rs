//! Removal; a leaf that becomes empty gives its parent's place to its sibling.

use crate::tree::node::Link;
use crate::{Primitive, Tree, TreeError};

impl Tree {
    /// Takes a primitive out and returns it. Its index is never given out again.
    ///
    /// The boxes of the nodes that held it are not tightened; see [`Self::tighten`]. Costs the
    /// depth of the tree, and one pass over the index arrays.
    ///
    /// # Errors
    /// [`TreeError::NoSuchPrimitive`] when the index was never given out or is already removed.
    pub fn remove(&mut self, index: usize) -> Result<Primitive, TreeError> {
        let leaf = self.leaf_of.get(index).and_then(|leaf| leaf.get());
        let leaf = leaf.ok_or(TreeError::NoSuchPrimitive { index })?;
        let primitive = self.primitives.get(index as u32);
        self.leaf_of[index] = Link::NONE;
        self.refined.clear(index as u32);
        self.close_gap(leaf, index as u32);
        if self.nodes[leaf as usize].count > 0 {
            self.update_up(leaf);
        } else {
            let above = self.detach(leaf);
            above.into_iter().for_each(|above| self.update_up(above));
        }
        Ok(primitive)
    }

    /// Takes an index out of the range of its leaf, and moves the ranges behind it.
    fn close_gap(&mut self, leaf: u32, index: u32) {
        let start = self.nodes[leaf as usize].start;
        let within = self.indices_of(leaf).iter().take_while(|&&other| other != index).count();
        let position = start + within as u32;
        self.order.remove(position as usize);
        for node in &mut self.nodes {
            if node.start > position {
                node.start -= 1;
            }
        }
        // The leaf and its ancestors begin at or before `position`: only their length changes.
        for id in self.path_up(leaf) {
            self.nodes[id as usize].count -= 1;
        }
    }

    /// Removes an empty leaf and its parent; the sibling moves up and keeps its name. Returns what is above
    /// them.
    pub(crate) fn detach(&mut self, leaf: u32) -> Option<u32> {
        let parent = self.nodes[leaf as usize].parent;
        self.release(leaf);
        let Some(parent) = parent.get() else {
            self.root = None;
            return None;
        };
        let grandparent = self.nodes[parent as usize].parent;
        let siblings = self.nodes[parent as usize].children().unwrap_or([leaf; 2]);
        let sibling = if siblings[0] == leaf { siblings[1] } else { siblings[0] };
        self.release(parent);
        self.nodes[sibling as usize].parent = grandparent;
        match grandparent.get() {
            None => self.root = Some(sibling),
            Some(above) => {
                let above = &mut self.nodes[above as usize];
                let moved_up = |child| if child == parent { sibling } else { child };
                above.set_children(above.children().map(|children| children.map(moved_up)));
            }
        }
        grandparent.get()
    }

    fn release(&mut self, id: u32) {
        let node = &mut self.nodes[id as usize];
        (node.count, node.parent) = (0, Link::NONE);
        node.set_children(None);
        self.free.push(id);
    }
}
