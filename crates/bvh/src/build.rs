//! Builds top-down: a node that holds too much, or is not flat enough, is halved along its
//! direction of largest variance.

use std::sync::OnceLock;

use cloudtouch_geom::Vector3;

use crate::bounds::SpreadBounds;
use crate::node::NodeData;
use crate::{Moments, Obb, Primitive, Tree, TreeError, TreeSettings};

/// Indices are 32 bit.
const MAX_PRIMITIVES: usize = u32::MAX as usize - 1;

impl Tree {
    /// Builds a tree over the primitives, which may be none.
    ///
    /// A node is split while it has too many primitives or too high a variation (see
    /// [`TreeSettings`]), at the median of the positions along the eigenvector of largest
    /// variance. The median always halves, equal positions being told apart by their index, so
    /// neither duplicates nor a grid can keep the splitting going, and the depth is log₂ n.
    /// O(n log n); the result depends on nothing but the input.
    ///
    /// # Errors
    /// When a setting is out of range, or a coordinate, covariance or weight is not a usable
    /// number.
    pub fn build(primitives: Vec<Primitive>, settings: &TreeSettings) -> Result<Self, TreeError> {
        settings.validate()?;
        if primitives.len() > MAX_PRIMITIVES {
            return Err(TreeError::TooMany { count: primitives.len() });
        }
        for (index, primitive) in primitives.iter().enumerate() {
            primitive.check(index)?;
        }
        let count = primitives.len();
        let mut tree = Self {
            settings: *settings,
            primitives,
            refined: vec![None; count],
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
    }

    /// Makes all nodes for `order`.
    fn grow(&mut self) {
        self.root = None;
        if !self.order.is_empty() {
            let root = self.new_node(None, 0, self.order.len() as u32);
            self.root = Some(root);
            self.fit_root();
            self.subdivide(root);
        }
        self.spread_when_built = self.spread();
    }

    /// Splits a fitted leaf, and its halves, as often as the settings ask for; then sets the
    /// bounds of what is below it.
    pub(crate) fn subdivide(&mut self, leaf: u32) {
        let mut stack = vec![leaf];
        while let Some(id) = stack.pop() {
            if self.should_split(id, self.fitted_variation(id)) {
                let children = self.split(id);
                self.fit_children(id, children);
                stack.extend(children);
            } else {
                let node = &self.nodes[id as usize];
                for &index in &self.order[node.start as usize..][..node.count as usize] {
                    self.leaf_of[index as usize] = Some(id);
                }
            }
        }
        self.update_bounds(Some(leaf));
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

    /// Halves the range of a node (of at least two primitives) at the median along the first box
    /// axis and returns two new, unfitted children.
    fn split(&mut self, id: u32) -> [u32; 2] {
        let NodeData { obb, moments, start, count, .. } = &self.nodes[id as usize];
        let (mean, start, count) = (moments.mean, *start, *count);
        let axis = obb.axes.column(0).into_owned();
        let range = &mut self.order[start as usize..][..count as usize];
        let mut keys: Vec<(f64, u32)> = range
            .iter()
            .map(|&i| (axis.dot(&(self.primitives[i as usize].centroid() - mean)), i))
            .collect();
        // The sign of an eigenvector is arbitrary and an odd count halves unevenly; letting the
        // longer tail point up makes the partition independent of the frame.
        if keys.iter().map(|(key, _)| key * key * key).sum::<f64>() < 0.0 {
            for (key, _) in &mut keys {
                *key = -*key;
            }
        }
        let half = count / 2;
        keys.select_nth_unstable_by(half as usize, |a, b| {
            a.0.total_cmp(&b.0).then_with(|| a.1.cmp(&b.1))
        });
        for (slot, (_, index)) in range.iter_mut().zip(keys) {
            *slot = index;
        }
        let left = self.new_node(Some(id), start, half);
        let right = self.new_node(Some(id), start + half, count - half);
        self.nodes[id as usize].children = Some([left, right]);
        [left, right]
    }

    /// A leaf over a range of `order`, not fitted yet.
    pub(crate) fn new_node(&mut self, parent: Option<u32>, start: u32, count: u32) -> u32 {
        let moments = Moments::of(&self.primitives, &[]);
        let node = NodeData {
            obb: Obb { centre: moments.mean, axes: moments.axes(), half_extents: Vector3::zeros() },
            moments,
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
