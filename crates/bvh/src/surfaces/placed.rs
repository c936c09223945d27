//! Where the boxes of two nodes are in one frame.

use cloudtouch_geom::Motion;

use crate::Obb;
use crate::tree::node::NodeData;

/// A place, or a direction.
pub(crate) type Array = [f64; 3];

/// A node, and where its box is in the frame of A.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Placed<'a> {
    pub(crate) node: &'a NodeData,
    pub(crate) centre: &'a Array,
    pub(crate) axes: &'a [Array; 3],
}

impl<'a> Placed<'a> {
    /// Where it was built.
    #[inline]
    pub(crate) fn at_home(node: &'a NodeData) -> Self {
        Self { node, centre: node.obb.centre.coords.as_ref(), axes: node.obb.axes.as_ref() }
    }

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
