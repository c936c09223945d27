//! The tree itself: flat arrays and the accessors over them.

mod bounding;
pub(crate) mod bounds;
pub(crate) mod bounds_list;
pub(crate) mod coverage;
pub(crate) mod moments;
pub(crate) mod node;
pub(crate) mod obb;
pub(crate) mod packed;
pub(crate) mod primitive;
pub(crate) mod primitives;
mod validate;
pub(crate) mod view;
pub(crate) mod visit;

use cloudtouch_geom::Covariance;

use crate::tree::bounds_list::BoundsList;
use crate::tree::coverage::{Coverages, fraction_outside};
use crate::tree::node::{Link, NodeData};
use crate::{NodeId, Primitive, Primitives, TreeSettings};

/// An oriented bounding box tree over uncertain points and exact triangles, in one frame.
///
/// Every primitive lies in exactly one leaf. Its index, the position in the list the tree was
/// built from or what [`Tree::insert`] returned, never changes and is never given out again.
#[derive(Debug, Clone)]
pub struct Tree {
    pub(crate) settings: TreeSettings,
    /// By index; removed ones keep their slot.
    pub(crate) primitives: Primitives,
    /// The bounds set for the refinement of primitives.
    pub(crate) refined: BoundsList,
    /// By index: how far the surface of a primitive reaches; shorter when none was set.
    pub(crate) extents: Vec<Covariance>,
    /// By index: the leaf that holds a primitive, none once removed.
    pub(crate) leaf_of: Vec<Link>,
    /// A permutation of the present indices; every node owns a contiguous range of it.
    pub(crate) order: Vec<u32>,
    pub(crate) nodes: Vec<NodeData>,
    pub(crate) coverages: Coverages,
    /// Slots of `nodes` that are not in use.
    pub(crate) free: Vec<u32>,
    pub(crate) root: Option<u32>,
    /// [`Tree::spread`] when last built.
    pub(crate) spread_when_built: f64,
}

impl Tree {
    /// The settings it was built with.
    pub fn settings(&self) -> &TreeSettings {
        &self.settings
    }

    /// How many primitives it holds.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether it holds no primitive.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// How many indices were ever given out: one more than the largest index.
    pub fn index_count(&self) -> usize {
        self.primitives.len()
    }

    /// The primitive with this index; `None` when there is none or it was removed.
    pub fn primitive(&self, index: usize) -> Option<Primitive> {
        self.leaf_of(index).map(|_| self.primitives.get(index as u32))
    }

    /// The leaf that holds this primitive; `None` when there is none or it was removed.
    pub fn leaf_of(&self, index: usize) -> Option<NodeId> {
        self.leaf_of.get(index)?.get().map(NodeId)
    }

    /// A number larger than [`NodeId::index`] of every node.
    pub fn node_slots(&self) -> usize {
        self.nodes.len()
    }

    /// The indices in the range of a node.
    pub(crate) fn indices_of(&self, id: u32) -> &[u32] {
        let node = &self.nodes[id as usize];
        &self.order[node.start as usize..][..node.count as usize]
    }

    /// 1 − P_cov of a node.
    pub(crate) fn fraction_outside(&self, id: u32) -> f64 {
        self.coverages.outside(id, self.nodes.len(), || {
            let below = self.indices_of(id).iter().map(|&i| self.primitives.get(i));
            fraction_outside(below, &self.nodes[id as usize].obb.unpacked())
        })
    }

    /// The nodes from `from` down, parents before children, left before right.
    pub(crate) fn preorder(&self, from: Option<u32>) -> Vec<u32> {
        let mut visited = Vec::new();
        let mut stack: Vec<u32> = from.into_iter().collect();
        while let Some(id) = stack.pop() {
            visited.push(id);
            if let Some([left, right]) = self.nodes[id as usize].children() {
                stack.extend([right, left]);
            }
        }
        visited
    }

    /// A node and its ancestors, bottom up.
    pub(crate) fn path_up(&self, from: u32) -> Vec<u32> {
        std::iter::successors(Some(from), |&id| self.nodes[id as usize].parent.get()).collect()
    }
}
