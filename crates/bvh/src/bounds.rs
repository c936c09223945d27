//! Bounds on the spread and the movement of a node's points, and how they climb the tree.

use cloudtouch_geom::{Matrix3, Vector3};

use crate::{Node, Primitive, Tree, TreeError};

/// What a later refinement may do to the points of a leaf.
///
/// An expensive noise model is run on a leaf only when a query first visits it; these bounds, cheap
/// to get beforehand, keep [`crate::Traversal::Certified`] right about leaves it never visits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeafBounds {
    /// The largest standard deviation (m) any of the points may have after refinement, in any
    /// direction; infinite when nothing is known.
    pub std: f64,
    /// How far (m) the mean of any of the points may move; finite.
    pub shift: f64,
}

/// Bounds on all points of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SpreadBounds {
    /// Largest standard deviation in any direction, m.
    pub(crate) max_std: f64,
    /// Largest standard deviation along each box axis, m.
    pub(crate) axis_std: Vector3,
    /// How far a mean may move, m.
    pub(crate) shift: f64,
}

impl SpreadBounds {
    pub(crate) const NONE: Self =
        Self { max_std: 0.0, axis_std: Vector3::new(0.0, 0.0, 0.0), shift: 0.0 };

    /// The bounds of one primitive seen along `axes`: those given for its refinement, else its
    /// own covariance.
    pub(crate) fn of(primitive: &Primitive, refined: Option<LeafBounds>, axes: &Matrix3) -> Self {
        if let Some(LeafBounds { std, shift }) = refined {
            return Self { max_std: std, axis_std: Vector3::repeat(std), shift };
        }
        let Some(covariance) = primitive.covariance() else { return Self::NONE };
        let [xx, xy, xz, yy, yz, zz] = covariance.upper_triangle();
        if xy == 0.0 && xz == 0.0 && yz == 0.0 && xx == yy && yy == zz {
            let std = xx.sqrt();
            return Self { max_std: std, axis_std: Vector3::repeat(std), shift: 0.0 };
        }
        Self {
            max_std: covariance.max_std(),
            axis_std: Vector3::from_fn(|k, _| covariance.std_along(&axes.column(k).into_owned())),
            shift: 0.0,
        }
    }

    /// The same bounds along other axes: |n·a_k| s_k adds up to at least the deviation along n.
    pub(crate) fn turned(&self, from: &Matrix3, to: &Matrix3) -> Self {
        let along = to.tr_mul(from).abs() * self.axis_std;
        Self { axis_std: along.map(|std| std.min(self.max_std)), ..*self }
    }

    /// Bounds that hold for both, seen along the same axes.
    pub(crate) fn max(&self, other: &Self) -> Self {
        Self {
            max_std: self.max_std.max(other.max_std),
            axis_std: self.axis_std.sup(&other.axis_std),
            shift: self.shift.max(other.shift),
        }
    }

    /// A bound on the standard deviation (m) along a unit vector, given the axes of the box.
    ///
    /// The deviation of a sum is at most the sum of the deviations, Σ |n·a_k| s_k.
    pub(crate) fn std_along(&self, axes: &Matrix3, direction: &Vector3) -> f64 {
        self.max_std.min(axes.tr_mul(direction).abs().dot(&self.axis_std))
    }
}

impl Tree {
    /// Sets, for every leaf, what a later refinement may do to its points, and carries it upward.
    ///
    /// From then on these bounds stand for the covariances of the points wherever a bound is
    /// wanted (not in the coverage, which describes the points as given). They stay with the
    /// primitives through [`Self::refit`], splits and [`Self::rebuild`]; a primitive inserted
    /// later has its own covariance and no shift until they are set again.
    ///
    /// # Errors
    /// [`TreeError::LeafBounds`] when a bound is negative or NaN, or a shift infinite; the tree is
    /// then unchanged.
    pub fn set_leaf_bounds(
        &mut self,
        mut bounds_of: impl FnMut(Node<'_>) -> LeafBounds,
    ) -> Result<(), TreeError> {
        let mut refined = self.refined.clone();
        for leaf in self.leaves() {
            let bounds = bounds_of(leaf);
            if !(bounds.std >= 0.0 && bounds.shift >= 0.0 && bounds.shift.is_finite()) {
                let LeafBounds { std, shift } = bounds;
                return Err(TreeError::LeafBounds { leaf: leaf.id().index(), std, shift });
            }
            for &index in leaf.primitive_indices() {
                refined[index as usize] = Some(bounds);
            }
        }
        self.refined = refined;
        self.update_bounds(self.root);
        Ok(())
    }

    /// Recomputes the bounds of everything below `from` and of itself, children before parents.
    pub(crate) fn update_bounds(&mut self, from: Option<u32>) {
        for &id in self.preorder(from).iter().rev() {
            self.nodes[id as usize].bounds = self.bounds_of(id);
        }
    }

    /// The bounds of a leaf from its primitives, of an inner node from those of its children.
    pub(crate) fn bounds_of(&self, id: u32) -> SpreadBounds {
        let node = &self.nodes[id as usize];
        let axes = &node.obb.axes;
        let largest = |all: SpreadBounds, one: SpreadBounds| all.max(&one);
        match node.children {
            None => (self.indices_of(id).iter().map(|&i| i as usize))
                .map(|i| SpreadBounds::of(&self.primitives[i], self.refined[i], axes))
                .fold(SpreadBounds::NONE, largest),
            Some(children) => (children.map(|child| &self.nodes[child as usize]).iter())
                .map(|child| child.bounds.turned(&child.obb.axes, axes))
                .fold(SpreadBounds::NONE, largest),
        }
    }
}
