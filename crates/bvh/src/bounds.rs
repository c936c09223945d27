//! Bounds on the spread and the movement of a node's points, and how they climb the tree.

use cloudtouch_geom::{Covariance, Matrix3, Vector3};

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
    /// How far (m) the surface that any of the points stands for may reach from its mean, in any
    /// direction; finite.
    pub reach: f64,
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
    /// How far the surface a point stands for reaches from its mean, in any direction and along each
    /// box axis, m.
    pub(crate) max_reach: f64,
    pub(crate) axis_reach: Vector3,
}

impl SpreadBounds {
    pub(crate) const NONE: Self = Self {
        max_std: 0.0,
        axis_std: Vector3::new(0.0, 0.0, 0.0),
        shift: 0.0,
        max_reach: 0.0,
        axis_reach: Vector3::new(0.0, 0.0, 0.0),
    };

    /// The bounds of one primitive seen along `axes`: those given for its refinement, else its
    /// own covariance and the extent given.
    pub(crate) fn of(
        primitive: &Primitive,
        refined: Option<LeafBounds>,
        extent: Option<&Covariance>,
        axes: &Matrix3,
    ) -> Self {
        let own = Self::NONE;
        if let Some(LeafBounds { std, shift, reach }) = refined {
            return Self { shift, ..own.with_std(std).with_reach(reach) };
        }
        let own = match primitive.covariance() {
            None => own,
            Some(covariance) => match covariance.isotropic_variance() {
                Some(variance) => own.with_std(variance.sqrt()),
                None => {
                    Self { max_std: covariance.max_std(), axis_std: along(covariance, axes), ..own }
                }
            },
        };
        match extent {
            None => own,
            Some(extent) => {
                Self { max_reach: extent.max_std(), axis_reach: along(extent, axes), ..own }
            }
        }
    }

    fn with_std(self, std: f64) -> Self {
        Self { max_std: std, axis_std: Vector3::repeat(std), ..self }
    }

    fn with_reach(self, reach: f64) -> Self {
        Self { max_reach: reach, axis_reach: Vector3::repeat(reach), ..self }
    }

    /// The same bounds along other axes: |n·a_k| s_k adds up to at least the deviation along n, and
    /// as much for the reach.
    pub(crate) fn turned(&self, from: &Matrix3, to: &Matrix3) -> Self {
        let turn = to.tr_mul(from).abs();
        let axis_std = (turn * self.axis_std).map(|std| std.min(self.max_std));
        let axis_reach = (turn * self.axis_reach).map(|reach| reach.min(self.max_reach));
        Self { axis_std, axis_reach, ..*self }
    }

    /// Bounds that hold for both, seen along the same axes.
    pub(crate) fn max(&self, other: &Self) -> Self {
        Self {
            max_std: self.max_std.max(other.max_std),
            axis_std: self.axis_std.sup(&other.axis_std),
            shift: self.shift.max(other.shift),
            max_reach: self.max_reach.max(other.max_reach),
            axis_reach: self.axis_reach.sup(&other.axis_reach),
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
            let is_length = |value: f64| value >= 0.0 && value.is_finite();
            if !(bounds.std >= 0.0 && is_length(bounds.shift) && is_length(bounds.reach)) {
                let LeafBounds { std, shift, reach } = bounds;
                return Err(TreeError::LeafBounds { leaf: leaf.id().index(), std, shift, reach });
            }
            for &index in leaf.primitive_indices() {
                refined[index as usize] = Some(bounds);
            }
        }
        self.refined = refined;
        self.extents.clear();
        self.update_bounds(self.root);
        Ok(())
    }

    /// Sets, by index, how far the surface that a primitive stands for reaches from its mean, and
    /// carries it upward: along a unit vector n √(nᵀEn), E the extent. Without it no surface reaches
    /// beyond the primitives themselves.
    ///
    /// What [`Self::set_leaf_bounds`] said is forgotten, as extents are when it is called: either the
    /// primitives are what they will stay or they are not. Every node's bounds are taken from its
    /// primitives, O(n log n). Extents stay with the primitives as bounds do; a primitive inserted
    /// later has none.
    ///
    /// # Errors
    /// [`TreeError::Count`] when there is not one for every index; the tree is then unchanged.
    pub fn set_extents(&mut self, extents: Vec<Covariance>) -> Result<(), TreeError> {
        if extents.len() != self.primitives.len() {
            let (expected, found) = (self.primitives.len(), extents.len());
            return Err(TreeError::Count { expected, found });
        }
        self.extents = extents;
        self.refined.fill(None);
        self.update_bounds(self.root);
        Ok(())
    }

    /// The bounds of one primitive seen along `axes`.
    pub(crate) fn bounds_of_primitive(&self, index: u32, axes: &Matrix3) -> SpreadBounds {
        let index = index as usize;
        let extent = self.extents.get(index);
        SpreadBounds::of(&self.primitives[index], self.refined[index], extent, axes)
    }

    /// Recomputes the bounds of everything below `from` and of itself, children before parents.
    pub(crate) fn update_bounds(&mut self, from: Option<u32>) {
        for &id in self.preorder(from).iter().rev() {
            self.nodes[id as usize].bounds = self.bounds_of(id);
        }
    }

    /// The bounds of a node from its primitives, or of an inner node from those of its children.
    ///
    /// The latter is cheap, and looser at each level where boxes are turned against one another:
    /// extents, which are set once for many traversals, are worth a pass over all primitives.
    pub(crate) fn bounds_of(&self, id: u32) -> SpreadBounds {
        let node = &self.nodes[id as usize];
        let axes = &node.obb.axes;
        let largest = |all: SpreadBounds, one: SpreadBounds| all.max(&one);
        let Some(children) = node.children else {
            return (self.indices_of(id).iter())
                .map(|&index| self.bounds_of_primitive(index, axes))
                .fold(SpreadBounds::NONE, largest);
        };
        let from_children = (children.map(|child| &self.nodes[child as usize]).iter())
            .map(|child| child.bounds.turned(&child.obb.axes, axes))
            .fold(SpreadBounds::NONE, largest);
        if self.extents.is_empty() {
            return from_children;
        }
        let mut tight = SpreadBounds {
            axis_std: Vector3::zeros(),
            axis_reach: Vector3::zeros(),
            ..from_children
        };
        for &index in self.indices_of(id) {
            let index = index as usize;
            if let Some(extent) = self.extents.get(index) {
                tight.axis_reach = tight.axis_reach.sup(&along(extent, axes));
            }
            if let Some(covariance) = self.primitives[index].covariance() {
                tight.axis_std = tight.axis_std.sup(&along(covariance, axes));
            }
        }
        tight
    }
}

/// Standard deviations along three axes.
fn along(covariance: &Covariance, axes: &Matrix3) -> Vector3 {
    let std = |k| covariance.std_along(&axes.column(k).into_owned());
    Vector3::new(std(0), std(1), std(2))
}
