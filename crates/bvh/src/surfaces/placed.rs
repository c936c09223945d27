//! Where the box of a node is in the frame of another tree.

use cloudtouch_geom::Motion;

use crate::Obb;
use crate::tree::node::NodeData;

/// A place, or a direction.
pub(crate) type Array = [f64; 3];

/// A node of B, and where its box is in the frame of A.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub(crate) node: &'a NodeData,
    pub(crate) centre: &'a Array,
    pub(crate) axes: &'a [Array; 3],
}

impl<'a> Placed<'a> {
    #[inline]
    pub(crate) fn moved(node: &'a NodeData, moved: &'a MovedBox) -> Self {
        Self { node, centre: &moved.centre, axes: &moved.axes }
    }
}

/// Middle and axes of a box in another frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MovedBox {
    pub(crate) centre: Array,
    pub(crate) axes: [Array; 3],
}

impl MovedBox {
    pub(crate) fn new(obb: &Obb, motion: &Motion) -> Self {
        let axes = motion.rotation() * obb.axes;
        Self { centre: motion.point(&obb.centre).into(), axes: axes.into() }
    }
}
