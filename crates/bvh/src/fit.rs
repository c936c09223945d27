//! Fits moments and box of a node to its primitives; used by build and refit alike, so
//! that a refit tree has the boxes a builder would give the same partition.

use cloudtouch_geom::Vector3;

use crate::{Moments, Obb, Tree};

impl Tree {
    /// Fits the root, which no sibling grows.
    pub(crate) fn fit_root(&mut self) {
        if let Some(root) = self.root {
            let (moments, obb) = self.fitted(root);
            self.set_shape(root, moments, obb);
        }
    }

    /// Fits both children of a node and lets their boxes overlap.
    pub(crate) fn fit_children(&mut self, parent: u32, [left, right]: [u32; 2]) {
        let (left_moments, mut left_box) = self.fitted(left);
        let (right_moments, mut right_box) = self.fitted(right);
        let parent = &self.nodes[parent as usize].obb;
        let axis: Vector3 = parent.axes.column(0).into_owned();
        let wanted = self.settings.sibling_overlap * 2.0 * parent.half_extents[0];
        if axis.dot(&(right_moments.mean - left_moments.mean)) >= 0.0 {
            overlap(&mut left_box, &mut right_box, &axis, wanted);
        } else {
            overlap(&mut right_box, &mut left_box, &axis, wanted);
        }
        self.set_shape(left, left_moments, left_box);
        self.set_shape(right, right_moments, right_box);
    }

    fn fitted(&self, id: u32) -> (Moments, Obb) {
        let indices = self.indices_of(id);
        let moments = Moments::of(&self.primitives, indices);
        let corners = indices.iter().flat_map(|&i| self.primitives[i as usize].corners());
        let obb = Obb::enclosing(moments.axes(), moments.mean, corners);
        (moments, obb)
    }

    fn set_shape(&mut self, id: u32, moments: Moments, obb: Obb) {
        let node = &mut self.nodes[id as usize];
        (node.moments, node.obb) = (moments, obb);
        node.outside.take();
    }

    /// Sums moments and bounds anew from a leaf (or a node just split) up to the root, and forgets
    /// the coverages, leaving the boxes as they are.
    pub(crate) fn update_up(&mut self, from: u32) {
        for id in self.path_up(from) {
            let moments = match self.nodes[id as usize].children {
                None => Moments::of(&self.primitives, self.indices_of(id)),
                Some([left, right]) => {
                    self.nodes[left as usize].moments.merged(&self.nodes[right as usize].moments)
                }
            };
            let bounds = self.bounds_of(id);
            let node = &mut self.nodes[id as usize];
            (node.moments, node.bounds) = (moments, bounds);
            node.outside.take();
        }
    }
}

/// Grows two boxes toward one another along `axis`, `low` upward and `high` downward by the same
/// amount, until their projections on it overlap by `wanted`.
///
/// The paper only says that siblings overlap. Growing boxes keeps every point in one leaf, which
/// holding seam points twice would not, so no point is solved or counted twice.
fn overlap(low: &mut Obb, high: &mut Obb, axis: &Vector3, wanted: f64) {
    let between_centres = axis.dot(&(high.centre - low.centre));
    let present = low.half_width_along(axis) + high.half_width_along(axis) - between_centres;
    if present < wanted {
        let growth = 0.5 * (wanted - present);
        low.extend(&(axis * growth));
        high.extend(&(axis * -growth));
    }
}
