//! Nodes: how they are stored and what a caller sees of them.

use std::sync::OnceLock;

use cloudtouch_geom::Vector3;

use crate::bounds::SpreadBounds;
use crate::{Moments, Obb, Tree};

/// Names a node of one tree; stable until that node is split, removed or rebuilt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    /// A number below [`Tree::node_slots`], for use as an index into data kept per node.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A node as stored. Slots of removed nodes are kept and used again.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NodeData {
    pub(crate) obb: Obb,
    pub(crate) moments: Moments,
    /// 1 − P_cov, computed when first asked for: it takes a pass over all points of the node, and
    /// `Certified` never asks.
    pub(crate) outside: OnceLock<f64>,
    pub(crate) bounds: SpreadBounds,
    pub(crate) parent: Option<u32>,
    /// `None` for a leaf.
    pub(crate) children: Option<[u32; 2]>,
    /// Where its primitives begin in `Tree::order`; they are contiguous, for inner nodes too.
    pub(crate) start: u32,
    pub(crate) count: u32,
    pub(crate) in_use: bool,
}

impl NodeData {
    /// The box that holds the surface its primitives stand for.
    pub(crate) fn surface_box(&self) -> Obb {
        Obb { half_extents: self.obb.half_extents + self.bounds.axis_reach, ..self.obb }
    }

    /// How much farther than the box of the points that of the surface reaches along a unit vector,
    /// m.
    pub(crate) fn reach_along(&self, direction: &Vector3) -> f64 {
        self.obb.axes.tr_mul(direction).abs().dot(&self.bounds.axis_reach)
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

    /// Its name in the tree.
    pub fn id(&self) -> NodeId {
        NodeId(self.id)
    }

    /// The box that holds all its primitives, in the frame of the tree. [`Self::shift`] is not
    /// part of it.
    pub fn obb(&self) -> &'a Obb {
        &self.data().obb
    }

    /// Mean and spread of the positions of its primitives.
    pub fn moments(&self) -> &'a Moments {
        &self.data().moments
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
        self.data().bounds.max_std
    }

    /// A bound on the standard deviation (m) of its points along a unit vector; never too small,
    /// and at most [`Self::max_std`].
    pub fn std_along(&self, direction: &Vector3) -> f64 {
        self.data().bounds.std_along(&self.obb().axes, direction)
    }

    /// How far (m) the means of its points may still move; see [`Tree::set_leaf_bounds`].
    pub fn shift(&self) -> f64 {
        self.data().bounds.shift
    }

    /// A bound on how far (m) the surface its points stand for reaches from their means; see
    /// [`LeafBounds::reach`](crate::LeafBounds::reach) and [`Tree::set_extents`].
    pub fn reach(&self) -> f64 {
        self.data().bounds.max_reach
    }

    /// Whether it has no children.
    pub fn is_leaf(&self) -> bool {
        self.data().children.is_none()
    }

    /// The node it is a child of; `None` for the root.
    pub fn parent(&self) -> Option<NodeId> {
        self.data().parent.map(NodeId)
    }

    /// Its two children; `None` for a leaf.
    pub fn children(&self) -> Option<[NodeId; 2]> {
        self.data().children.map(|pair| pair.map(NodeId))
    }

    /// Indices of all primitives below it, at least one.
    pub fn primitive_indices(&self) -> &'a [u32] {
        self.tree.indices_of(self.id)
    }
}
