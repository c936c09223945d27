//! Fits the box of a node to its primitives; used by build and refit alike, so
//! that a refit tree has the boxes a builder would give the same partition.

use cloudtouch_geom::{Point3, Vector3};

use crate::{Moments, Obb, Tree};

impl Tree {
    /// Fits a node that no sibling grows, such as the root, and says what it holds.
    pub(crate) fn fit(&mut self, id: u32) -> Moments {
        let (moments, obb) = self.fitted(id);
        self.set_shape(id, obb);
        moments
    }

    /// Fits both children of a node.
    pub(crate) fn fit_children(&mut self, parent: u32, children: [u32; 2]) {
        let fitted = children.map(|child| self.fitted(child));
        let obb = self.nodes[parent as usize].obb.unpacked();
        let overlapping = overlapping(&obb, fitted, self.settings.sibling_overlap);
        for (child, (_, obb)) in children.into_iter().zip(overlapping) {
            self.set_shape(child, obb);
        }
    }

    pub(crate) fn fitted(&self, id: u32) -> (Moments, Obb) {
        fitted(self.corners_of(id))
    }

    /// The corners of each primitive of a node.
    fn corners_of(&self, id: u32) -> impl Iterator<Item = &[Point3]> + Clone {
        self.indices_of(id).iter().map(|&i| self.primitives.corners(i))
    }

    pub(crate) fn moments_of(&self, id: u32) -> Moments {
        Moments::of(self.corners_of(id))
    }

    pub(crate) fn set_shape(&mut self, id: u32, obb: Obb) {
        self.nodes[id as usize].obb = (&obb).into();
        self.coverages.forget();
    }

    /// Takes bounds anew from a leaf (or a node just split) up to the root, and forgets the coverages, leaving
    /// the boxes as they are.
    pub(crate) fn update_up(&mut self, from: u32) {
        for id in self.path_up(from) {
            self.set_bounds(id);
        }
        self.coverages.forget();
    }
}

/// Moments and box of primitives, given by their corners.
pub(crate) fn fitted<'a>(primitives: impl Iterator<Item = &'a [Point3]> + Clone) -> (Moments, Obb) {
    let moments = Moments::of(primitives.clone());
    let obb = Obb::enclosing(moments.axes(), moments.mean, primitives.flatten());
    (moments, obb)
}

/// Both halves of a node with this box, their boxes grown until they overlap by this share of it.
pub(crate) fn overlapping(
    parent: &Obb,
    fitted: [(Moments, Obb); 2],
    share: f64,
) -> [(Moments, Obb); 2] {
    let [(first, mut first_box), (second, mut second_box)] = fitted;
    let axis: Vector3 = parent.axes.column(0).into_owned();
    let wanted = share * 2.0 * parent.half_extents[0];
    let is_in_order = axis.dot(&(second.mean - first.mean)) >= 0.0;
    let (low, high) = if is_in_order {
        (&mut first_box, &mut second_box)
    } else {
        (&mut second_box, &mut first_box)
    };
    // Without an overlap, boxes are as they fit, and what is between them is in neither.
    if wanted > 0.0 {
        overlap(low, high, &axis, wanted);
    }
    [(first, first_box), (second, second_box)]
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
