//! Nodes: their names, and how they are stored.

use std::sync::OnceLock;

use cloudtouch_geom::Pose;

use crate::Obb;
use crate::tree::bounds::SpreadBounds;

/// Names a node of one tree; stable until that node is split, removed or rebuilt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    /// A number below [`Tree::node_slots`](crate::Tree::node_slots), for use as an index into data kept per node.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A node as stored. Slots of removed nodes are kept and used again.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NodeData {
    pub(crate) obb: Obb,
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
    /// A leaf over a range of the order, without bounds, that nothing is above.
    pub(crate) fn leaf(start: u32, count: u32, obb: Obb) -> Self {
        Self {
            obb,
            outside: OnceLock::new(),
            bounds: SpreadBounds::NONE,
            parent: None,
            children: None,
            start,
            count,
            in_use: true,
        }
    }
}

/// How far a pose can misplace a box below one of two roots by rounding, m.
pub(crate) fn pose_rounding(roots: [&NodeData; 2], a_from_b: &Pose) -> f64 {
    let reach = |root: &NodeData| root.obb.centre.coords.norm() + 3.0 * root.obb.radius();
    let [a, b] = roots.map(reach);
    16.0 * f64::EPSILON * (a + b + a_from_b.translation().norm())
}
