//! Builds top-down: a node that holds too much, or is not flat enough, is halved along its
//! direction of largest variance; first of all what is far from the rest is set apart.

use std::sync::OnceLock;

use cloudtouch_geom::{Matrix3, Point3, Vector3};

use crate::bounds::SpreadBounds;
use crate::bounds_list::BoundsList;
use crate::node::NodeData;
use crate::parts::Parts;
use crate::{LeafBounds, Moments, Node, Obb, Primitive, Primitives, Tree, TreeError, TreeSettings};

/// Indices are 32 bit.
const MAX_PRIMITIVES: usize = u32::MAX as usize - 1;

impl Tree {
    /// Builds a tree over the primitives, which may be none.
    ///
    /// A node is split while it has too many primitives or too high a variation (see
    /// [`TreeSettings`]), at the median of the positions along the eigenvector of largest
    /// variance. The median always halves, equal positions being told apart by their index, so
    /// neither duplicates nor a grid can keep the splitting going, and the depth is log₂ n, and a little more:
    /// what is more than four times as far from the middle of all as half of them is set apart first, and
    /// of the rest again, so that a few returns from far away leave the tree over the others as it is
    /// without them.
    /// O(n log n); the result depends on nothing but the input.
    ///
    /// # Errors
    /// When a setting is out of range, or a coordinate, covariance or weight is not a usable
    /// number.
    pub fn build(primitives: Vec<Primitive>, settings: &TreeSettings) -> Result<Self, TreeError> {
        let mut tree = Self::partitioned(Primitives::Each(primitives), settings)?;
        tree.update_bounds(tree.root);
        Ok(tree)
    }

    /// [`Self::build`] and [`Self::set_leaf_bounds`] in one: bounds that would be replaced at once are
    /// never computed. `bounds_of` is given the tree and each of its leaves in turn, in which all is as
    /// it will be but the bounds.
    ///
    /// # Errors
    /// As either of the two.
    pub fn build_bounded(
        primitives: Primitives,
        settings: &TreeSettings,
        mut bounds_of: impl FnMut(&Self, Node<'_>) -> LeafBounds,
    ) -> Result<Self, TreeError> {
        let mut tree = Self::partitioned(primitives, settings)?;
        tree.refined = tree.listed(|leaf| bounds_of(&tree, leaf))?;
        tree.update_bounds(tree.root);
        Ok(tree)
    }

    /// All but the bounds.
    fn partitioned(primitives: Primitives, settings: &TreeSettings) -> Result<Self, TreeError> {
        settings.validate()?;
        if primitives.len() > MAX_PRIMITIVES {
            return Err(TreeError::TooMany { count: primitives.len() });
        }
        primitives.check()?;
        let count = primitives.len();
        let mut tree = Self {
            settings: *settings,
            primitives,
            refined: BoundsList::default(),
            extents: Vec::new(),
            leaf_of: vec![None; count],
            order: (0..count as u32).collect(),
            nodes: Vec::new(),
            free: Vec::new(),
            root: None,
            spread_when_built: 0.0,
        };
        tree.grow();
        Ok(tree)
    }

    /// Discards all nodes and builds anew over the primitives present, with their indices.
    ///
    /// Bounds set by [`Self::set_leaf_bounds`] stay with the primitives; node names change.
    pub fn rebuild(&mut self) {
        self.nodes.clear();
        self.free.clear();
        // The order of indices, so that the result is that of a build and not of the history.
        self.order.sort_unstable();
        self.grow();
        self.update_bounds(self.root);
    }

    /// Makes all nodes for `order`, without bounds.
    fn grow(&mut self) {
        self.root = None;
        if !self.order.is_empty() {
            let root = self.new_node(None, 0, self.order.len() as u32);
            self.root = Some(root);
            self.fit_root();
            self.partition(root);
        }
        self.nodes.shrink_to_fit();
        self.spread_when_built = self.spread();
    }

    /// Splits a fitted leaf, and its halves, as often as the settings ask for; then sets the
    /// bounds of what is below it.
    pub(crate) fn subdivide(&mut self, leaf: u32) {
        self.partition(leaf);
        self.update_bounds(Some(leaf));
    }

    fn partition(&mut self, leaf: u32) {
        let start = self.nodes[leaf as usize].start;
        let mut parts = Parts::of(&self.primitives, self.indices_of(leaf));
        // Only all of them are asked for what is far, and what is left then: of a part its ends would be.
        let is_root = self.nodes[leaf as usize].parent.is_none();
        let mut all_but_far = is_root.then_some(leaf);
        let mut stack = vec![leaf];
        while let Some(id) = stack.pop() {
            let node = &self.nodes[id as usize];
            let range = (node.start - start) as usize..(node.start - start + node.count) as usize;
            if self.should_split(id, self.fitted_variation(id)) {
                let NodeData { obb, moments, .. } = &self.nodes[id as usize];
                let (axis, mean) = (obb.axes.column(0).into_owned(), moments.mean);
                let is_all = all_but_far == Some(id);
                let far = is_all.then(|| parts.set_far_apart(range.clone(), &mean)).flatten();
                let middle = far.unwrap_or_else(|| parts.halve(range.clone(), &axis, &mean));
                let children = self.split(id, (middle - range.start) as u32);
                if is_all {
                    all_but_far = far.map(|_| children[0]);
                }
                let ranges = [range.start..middle, middle..range.end];
                let fitted = ranges.map(|range| parts.fitted(&self.primitives, range));
                self.set_children(id, children, fitted);
                stack.extend(children);
            } else {
                for part in &parts.all[range] {
                    self.leaf_of[part.index as usize] = Some(id);
                }
            }
        }
        for (slot, part) in self.order[start as usize..].iter_mut().zip(&parts.all) {
            *slot = part.index;
        }
    }

    pub(crate) fn should_split(&self, id: u32, variation: f64) -> bool {
        let count = self.nodes[id as usize].count as usize;
        count > self.settings.max_leaf_points
            || (count / 2 >= self.settings.min_leaf_points
                && variation > self.settings.max_variation)
    }

    /// The variation of a node whose box was just fitted: its last axis is that of the smallest
    /// eigenvalue, which need not be computed again.
    fn fitted_variation(&self, id: u32) -> f64 {
        let NodeData { moments, obb, .. } = &self.nodes[id as usize];
        let total = moments.covariance.std_bound().powi(2);
        let smallest = moments.covariance.variance_along(&obb.axes.column(2).into_owned());
        if total > 0.0 { smallest / total } else { 0.0 }
    }

    /// Gives a node (of at least two primitives) two new, unfitted children, the first with so many of its
    /// primitives, and returns them.
    fn split(&mut self, id: u32, first: u32) -> [u32; 2] {
        let NodeData { start, count, .. } = self.nodes[id as usize];
        let left = self.new_node(Some(id), start, first);
        let right = self.new_node(Some(id), start + first, count - first);
        self.nodes[id as usize].children = Some([left, right]);
        [left, right]
    }

    /// A leaf over a range of `order`, not fitted yet.
    pub(crate) fn new_node(&mut self, parent: Option<u32>, start: u32, count: u32) -> u32 {
        let node = NodeData {
            obb: Obb {
                centre: Point3::origin(),
                axes: Matrix3::identity(),
                half_extents: Vector3::zeros(),
            },
            moments: Moments::NONE,
            outside: OnceLock::new(),
            bounds: SpreadBounds::NONE,
            parent,
            children: None,
            start,
            count,
            in_use: true,
        };
        if let Some(id) = self.free.pop() {
            self.nodes[id as usize] = node;
            id
        } else {
            self.nodes.push(node);
            self.nodes.len() as u32 - 1
        }
    }
}
