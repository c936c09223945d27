//! Nodes: their names, and how they are stored.

use cloudtouch_geom::Pose;

use crate::Obb;
use crate::tree::bounds::SpreadBounds;
use crate::tree::packed::{PackedBounds, PackedObb};

/// Names a node of one tree; stable until that node is split, removed or rebuilt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    /// A number below [`Tree::node_slots`](crate::Tree::node_slots), for use as an index into data kept per node.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The name of a node, or of none, in as little as a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Link(u32);

impl Link {
    pub(crate) const NONE: Self = Self(u32::MAX);

    pub(crate) fn get(self) -> Option<u32> {
        (self != Self::NONE).then_some(self.0)
    }
}

impl From<u32> for Link {
    fn from(id: u32) -> Self {
        Self(id)
    }
}

/// A node as stored. Slots of removed nodes are kept and used again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NodeData {
    pub(crate) obb: PackedObb,
    pub(crate) bounds: PackedBounds,
    pub(crate) parent: Link,
    /// None for a leaf.
    children: [Link; 2],
    /// Where its primitives begin in `Tree::order`; they are contiguous, for inner nodes too.
    pub(crate) start: u32,
    /// None is left in a node that is not in use any more.
    pub(crate) count: u32,
}

impl NodeData {
    /// A leaf over a range of the order, without bounds, that nothing is above.
    pub(crate) fn leaf(start: u32, count: u32, obb: &Obb) -> Self {
        Self {
            obb: obb.into(),
            bounds: PackedBounds::NONE,
            parent: Link::NONE,
            children: [Link::NONE; 2],
            start,
            count,
        }
    }

    /// The same below a node.
    pub(crate) fn under(self, parent: Link) -> Self {
        Self { parent, ..self }
    }

    pub(crate) fn is_leaf(&self) -> bool {
        self.children[0] == Link::NONE
    }

    pub(crate) fn children(&self) -> Option<[u32; 2]> {
        let [left, right] = self.children.map(Link::get);
        left.zip(right).map(Into::into)
    }

    pub(crate) fn set_children(&mut self, children: Option<[u32; 2]>) {
        self.children = children.map_or([Link::NONE; 2], |children| children.map(Link::from));
    }

    /// Lets the bounds hold these too, which are along its axes.
    pub(crate) fn raise(&mut self, bounds: &SpreadBounds) {
        self.bounds = (&self.bounds.unpacked().max(bounds)).into();
    }

    /// Changes the box.
    pub(crate) fn resize(&mut self, change: impl FnOnce(&mut Obb)) {
        let mut obb = self.obb.unpacked();
        change(&mut obb);
        self.obb = (&obb).into();
    }
}

/// How far a pose can misplace a box below one of two roots by rounding, m.
pub(crate) fn pose_rounding(roots: [&NodeData; 2], a_from_b: &Pose) -> f64 {
    let reach =
        |root: &NodeData| root.obb.centre.coords.norm() + 3.0 * root.obb.half_extents().norm();
    let [a, b] = roots.map(reach);
    16.0 * f64::EPSILON * (a + b + a_from_b.translation().norm())
}
