//! How bounds on the points of a tree are set, and climb it.

use cloudtouch_geom::{Covariance, Matrix3, Vector3};
use rayon::prelude::*;

use crate::tree::bounds::{SpreadBounds, variances_along};
use crate::tree::bounds_list::BoundsList;
use crate::tree::packed::PackedBounds;
use crate::tree::primitive::check_extent;
use crate::{LeafBounds, Node, Tree, TreeError};

impl Tree {
    /// Sets, for every leaf, what a later refinement may do to its points, and carries it upward.
    ///
    /// From then on these bounds stand for the covariances of the points wherever a bound is
    /// wanted (not in the coverage, which describes the points as given). They stay with the
    /// primitives through [`Self::refit`], splits and [`Self::rebuild`], rounded up to single precision; a primitive inserted
    /// later has its own covariance and no shift until they are set again. `bounds_of` is called on all
    /// threads of the pool.
    ///
    /// # Errors
    /// [`TreeError::LeafBounds`] when a bound is negative or NaN, or a shift or reach infinite; the
    /// tree is then unchanged.
    pub fn set_leaf_bounds(
        &mut self,
        bounds_of: impl Fn(Node<'_>) -> LeafBounds + Sync,
    ) -> Result<(), TreeError> {
        let said = self.said_of_leaves(|leaf| (bounds_of(leaf), ()))?;
        self.extents.clear();
        self.take_bounds(&said);
        Ok(())
    }

    /// What is said of every leaf, in their order, with bounds that are some.
    pub(crate) fn said_of_leaves<T: Send>(
        &self,
        of_leaf: impl Fn(Node<'_>) -> (LeafBounds, T) + Sync,
    ) -> Result<Vec<(LeafBounds, T)>, TreeError> {
        let leaves: Vec<Node<'_>> = self.leaves().collect();
        let said: Vec<(LeafBounds, T)> = leaves.par_iter().map(|&leaf| of_leaf(leaf)).collect();
        for (leaf, (bounds, _)) in leaves.into_iter().zip(&said) {
            bounds.check(leaf.id().index())?;
        }
        Ok(said)
    }

    /// Takes the bounds that were [said](Self::said_of_leaves) of every leaf, and carries them upward;
    /// there are no extents.
    pub(crate) fn take_bounds<T>(&mut self, said: &[(LeafBounds, T)]) {
        let leaves: Vec<u32> = self.leaves().map(|leaf| leaf.id).collect();
        self.refined = BoundsList::default();
        for (leaf, (bounds, _)) in leaves.into_iter().zip(said) {
            let Self { nodes, order, refined, primitives, .. } = self;
            let node = &mut nodes[leaf as usize];
            let own = &order[node.start as usize..][..node.count as usize];
            refined.set(own, *bounds, primitives.len());
            // PERF: those of all its primitives are the same, which need not be looked up for each.
            let of_all = SpreadBounds::of(None, Some(*bounds), None, &Matrix3::identity());
            node.bounds = PackedBounds::from(&of_all);
        }
        for id in self.preorder(self.root).into_iter().rev() {
            if !self.nodes[id as usize].is_leaf() {
                self.set_bounds(id);
            }
        }
    }

    /// Sets, by index, how far the surface that a primitive stands for reaches from its mean, and
    /// carries it upward: along a unit vector n √(nᵀEn), E the extent. Without it no surface reaches
    /// beyond the primitives themselves.
    ///
    /// What [`Self::set_leaf_bounds`] said is forgotten, as extents are when it is called: either the
    /// primitives are what they will stay or they are not. Every node's bounds are taken from its
    /// primitives, O(n log n), those of leaves on all threads of the pool. Extents stay with the
    /// primitives as bounds do; a primitive inserted later has none.
    ///
    /// # Errors
    /// [`TreeError::Count`] when there is not one for every index, [`TreeError::Extent`] when one is not a usable
    /// number; the tree is then unchanged.
    pub fn set_extents(&mut self, extents: Vec<Covariance>) -> Result<(), TreeError> {
        self.take_extents(extents)?;
        self.update_all_bounds();
        Ok(())
    }

    /// [`Self::set_extents`] by the caller alone, who may have what others wait for.
    ///
    /// # Errors
    /// As [`Self::set_extents`].
    pub fn set_extents_on_this_thread(
        &mut self,
        extents: Vec<Covariance>,
    ) -> Result<(), TreeError> {
        self.take_extents(extents)?;
        self.update_bounds(self.root);
        Ok(())
    }

    /// Takes them instead of what was said of leaves; no bound is set yet.
    fn take_extents(&mut self, extents: Vec<Covariance>) -> Result<(), TreeError> {
        if extents.len() != self.primitives.len() {
            let (expected, found) = (self.primitives.len(), extents.len());
            return Err(TreeError::Count { expected, found });
        }
        extents.iter().enumerate().try_for_each(|(index, extent)| check_extent(extent, index))?;
        self.extents = extents;
        self.refined = BoundsList::default();
        Ok(())
    }

    /// The bounds of one primitive seen along `axes`.
    pub(crate) fn bounds_of_primitive(&self, index: u32, axes: &Matrix3) -> SpreadBounds {
        let extent = self.extents.get(index as usize);
        let covariance = self.primitives.covariance(index);
        SpreadBounds::of(covariance, self.refined.get(index), extent, axes)
    }

    /// Recomputes the bounds of everything below `from` and of itself, children before parents.
    pub(crate) fn update_bounds(&mut self, from: Option<u32>) {
        for &id in self.preorder(from).iter().rev() {
            self.set_bounds(id);
        }
    }

    /// Takes the bounds of a node anew.
    pub(crate) fn set_bounds(&mut self, id: u32) {
        self.nodes[id as usize].bounds = (&self.bounds_of(id)).into();
    }

    /// The same of all nodes, leaves on all threads of the pool.
    pub(crate) fn update_all_bounds(&mut self) {
        let (leaves, inner): (Vec<u32>, Vec<u32>) = (self.preorder(self.root).into_iter())
            .partition(|&id| self.nodes[id as usize].is_leaf());
        let of_leaves: Vec<SpreadBounds> =
            leaves.par_iter().map(|&leaf| self.bounds_of(leaf)).collect();
        for (leaf, bounds) in leaves.into_iter().zip(of_leaves) {
            self.nodes[leaf as usize].bounds = (&bounds).into();
        }
        for id in inner.into_iter().rev() {
            self.set_bounds(id);
        }
    }

    /// The bounds of a node from its primitives, or of an inner node from those of its children.
    ///
    /// The latter is cheap, and looser at each level where boxes are turned against one another:
    /// extents, which are set once for many traversals, are worth a pass over all primitives.
    pub(crate) fn bounds_of(&self, id: u32) -> SpreadBounds {
        let node = &self.nodes[id as usize];
        let axes = &node.obb.axes;
        let Some(children) = node.children() else {
            let mut bounds = SpreadBounds::NONE;
            let mut last = None;
            for &index in self.indices_of(id) {
                // Those of a leaf were mostly given the same.
                let refined = self.refined.get(index);
                if refined.is_none() || refined != last {
                    bounds = bounds.max(&self.bounds_of_primitive(index, axes));
                }
                last = refined;
            }
            return bounds;
        };
        let from_children = (children.map(|child| &self.nodes[child as usize]).iter())
            .map(|child| child.bounds.unpacked().turned(&child.obb.axes, axes))
            .fold(SpreadBounds::NONE, |all, one| all.max(&one));
        if self.extents.is_empty() {
            return from_children;
        }
        // PERF: the root of the largest, not the largest of the roots.
        let (mut reach, mut spread) = (Vector3::zeros(), Vector3::zeros());
        for &index in self.indices_of(id) {
            if self.refined.get(index).is_some() {
                // Bounds set since stand for covariances that are none of the primitive's.
                return from_children;
            }
            if let Some(extent) = self.extents.get(index as usize) {
                reach = reach.sup(&variances_along(extent, axes));
            }
            if let Some(covariance) = self.primitives.covariance(index) {
                spread = spread.sup(&variances_along(covariance, axes));
            }
        }
        let [axis_reach, axis_std] = [reach, spread].map(|squared| squared.map(f64::sqrt));
        SpreadBounds { axis_std, axis_reach, ..from_children }
    }
}
