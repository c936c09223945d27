//! Nodes: their names, and how they are stored.

use std::sync::OnceLock;

use cloudtouch_geom::Pose;

use crate::tree::bounds::SpreadBounds;
use crate::{Moments, Obb};

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
    /// A leaf over a range of the order, without bounds, that nothing is above.
    pub(crate) fn leaf(start: u32, count: u32, moments: Moments, obb: Obb) -> Self {
        Self {
            obb,
            moments,
            outside: OnceLock::new(),
            bounds: SpreadBounds::NONE,
            parent: None,
            children: None,
            start,
            count,
            in_use: true,
        }
    }

    /// The variation of a node whose box was just fitted: its last axis is that of the smallest
    /// eigenvalue, which need not be computed again.
    pub(crate) fn fitted_variation(&self) -> f64 {
        let covariance = &self.moments.covariance;
        let total = covariance.std_bound().powi(2);
        let smallest = covariance.variance_along(&self.obb.axes.column(2).into_owned());
        if total > 0.0 { smallest / total } else { 0.0 }
    }
}

/// How far a pose can misplace a box below one of two roots by rounding, m.
pub(crate) fn pose_rounding(roots: [&NodeData; 2], a_from_b: &Pose) -> f64 {
    let reach = |root: &NodeData| root.obb.centre.coords.norm() + 3.0 * root.obb.radius();
    let [a, b] = roots.map(reach);
    16.0 * f64::EPSILON * (a + b + a_from_b.translation().norm())
}
