//! What a caller sees of a tree: its nodes.

use cloudtouch_geom::Vector3;

use crate::tree::bounds::SpreadBounds;
use crate::tree::node::NodeData;
use crate::{Moments, NodeId, Obb, Tree};

impl Tree {
    /// The node over everything; `None` in an empty tree.
    pub fn root(&self) -> Option<Node<'_>> {
        self.root.map(|id| Node { tree: self, id })
    }

    /// A node by name; `None` when it is not, or no longer, in the tree.
    pub fn node(&self, id: NodeId) -> Option<Node<'_>> {
        self.nodes
            .get(id.index())
            .filter(|node| node.count > 0)
            .map(|_| Node { tree: self, id: id.0 })
    }

    /// A leaf by name; `None` when the name is not, or no longer, that of a leaf.
    pub fn leaf(&self, id: NodeId) -> Option<Node<'_>> {
        self.node(id).filter(Node::is_leaf)
    }

    /// All leaves, in the order of their names.
    pub fn leaves(&self) -> impl Iterator<Item = Node<'_>> {
        (0..self.nodes.len() as u32).filter_map(|id| self.leaf(NodeId(id)))
    }
}

/// A node of a tree, to look at.
#[derive(Debug, Clone, Copy)]
pub struct Node<'a> {
    pub(crate) tree: &'a Tree,
    pub(crate) id: u32,
}

impl<'a> Node<'a> {
    fn data(&self) -> &'a NodeData {
        &self.tree.nodes[self.id as usize]
    }

    fn bounds(&self) -> SpreadBounds {
        self.data().bounds.unpacked()
    }

    /// Its name in the tree.
    pub fn id(&self) -> NodeId {
        NodeId(self.id)
    }

    /// The box that holds all its primitives, in the frame of the tree. [`Self::shift`] is not
    /// part of it.
    pub fn obb(&self) -> Obb {
        self.data().obb.unpacked()
    }

    /// Mean and spread of the positions of its primitives, in a pass over them.
    pub fn moments(&self) -> Moments {
        self.tree.moments_of(self.id)
    }

    /// P_cov = 1 − Σ w_i P_out(x_i) / Σ w_i, in \[0, 1\]: the part of the surface expected inside
    /// the box.
    ///
    /// Of the points as given, whatever [`Tree::set_leaf_bounds`] says about their refinement.
    /// Computed when first asked for (O(n) in the points of the node) and kept.
    pub fn coverage(&self) -> f64 {
        1.0 - self.tree.fraction_outside(self.id)
    }

    /// The largest standard deviation (m) of any of its points in any direction; never too small.
    pub fn max_std(&self) -> f64 {
        self.bounds().max_std
    }

    /// A bound on the standard deviation (m) of its points along a unit vector; never too small,
    /// and at most [`Self::max_std`].
    pub fn std_along(&self, direction: &Vector3) -> f64 {
        self.bounds().std_along(&self.data().obb.axes, direction)
    }

    /// How far (m) the means of its points may still move; see [`Tree::set_leaf_bounds`].
    pub fn shift(&self) -> f64 {
        self.bounds().shift
    }

    /// A bound on how far (m) the surface its points stand for reaches from their means; see
    /// [`LeafBounds::reach`](crate::LeafBounds::reach) and [`Tree::set_extents`].
    pub fn reach(&self) -> f64 {
        self.bounds().max_reach
    }

    /// Whether it has no children.
    pub fn is_leaf(&self) -> bool {
        self.data().is_leaf()
    }

    /// The node it is a child of; `None` for the root.
    pub fn parent(&self) -> Option<NodeId> {
        self.data().parent.get().map(NodeId)
    }

    /// Its two children; `None` for a leaf.
    pub fn children(&self) -> Option<[NodeId; 2]> {
        self.data().children().map(|pair| pair.map(NodeId))
    }

    /// Indices of all primitives below it, at least one.
    pub fn primitive_indices(&self) -> &'a [u32] {
        self.tree.indices_of(self.id)
    }
}
