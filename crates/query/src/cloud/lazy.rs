//! Leaves whose noise model is computed when a query first visits them, and kept.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use cloudtouch_bvh::{Node, NodeId, Tree};
use cloudtouch_geom::{UncertainPoint, Vector3};
use cloudtouch_noise::Scratch;

use super::Cloud;

/// A point of a leaf after the noise model, in the cloud's local frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LeafPoint {
    /// Index among the points the filter kept.
    pub index: u32,
    /// Where the surface is expected, and how well that is known.
    pub point: UncertainPoint,
    /// Distance between samples there, m.
    pub spacing: f64,
    /// Unit normal of the surface there, of either sign, where one was fitted.
    pub normal: Option<Vector3>,
}

/// One slot per tree node; only those of leaves are ever filled. Each is a pure function of the
/// cloud, so it does not matter which thread fills it.
#[derive(Debug)]
pub(super) struct LazyLeaves {
    slots: Vec<OnceLock<Vec<LeafPoint>>>,
    rims: Vec<OnceLock<Vec<LeafPoint>>>,
}

/// Neighbours of a point that are joined to it by edges.
const EDGE_NEIGHBORS: usize = 8;

impl LazyLeaves {
    pub(super) fn new(tree: &Tree) -> Self {
        let empty = || (0..tree.node_slots()).map(|_| OnceLock::new()).collect();
        Self { slots: empty(), rims: empty() }
    }
}

/// The spacing a point may be given at most, on which the tree's bounds rest: half more than that
/// of as many points spread evenly over the two longest sides of the leaf's box, or on a line.
pub(super) fn spacing_cap(leaf: Node<'_>) -> f64 {
    let mut sides: [f64; 3] = (2.0 * leaf.obb().half_extents).into();
    sides.sort_by(f64::total_cmp);
    let [_, middle, longest] = sides;
    let count = leaf.primitive_indices().len().max(1) as f64;
    // On a line the sixth neighbour, which the spacing is measured by, is three steps away.
    1.5 * (longest * middle / count).sqrt().max(3.0 * longest / count)
}

impl Cloud {
    /// The points of a leaf after the noise model, and whether this call computed them.
    pub(crate) fn leaf(&self, id: NodeId) -> (&[LeafPoint], bool) {
        let mut computed = false;
        let points = self.leaves.slots[id.index()].get_or_init(|| {
            computed = true;
            let Some(leaf) = self.tree.leaf(id) else { return Vec::new() };
            let cap = spacing_cap(leaf);
            let mut scratch = Scratch::default();
            let refine = |&index: &u32| self.refine(index, cap, &mut scratch);
            leaf.primitive_indices().iter().map(refine).collect()
        });
        (points, computed)
    }

    /// The neighbours of a leaf's points that lie in other leaves, after the noise model: a surface
    /// does not end where a leaf does.
    pub(crate) fn rim(&self, id: NodeId) -> &[LeafPoint] {
        self.leaves.rims[id.index()].get_or_init(|| {
            let Some(leaf) = self.tree.leaf(id) else { return Vec::new() };
            let own: BTreeSet<u32> = leaf.primitive_indices().iter().copied().collect();
            let neighbors_of =
                |&index: &u32| self.neighborhoods.nearest(index as usize, EDGE_NEIGHBORS);
            let rim: BTreeSet<u32> = own
                .iter()
                .flat_map(neighbors_of)
                .map(|neighbor| neighbor.index as u32)
                .filter(|index| !own.contains(index))
                .collect();
            let cap = spacing_cap(leaf);
            let mut scratch = Scratch::default();
            rim.iter().map(|&index| self.refine(index, cap, &mut scratch)).collect()
        })
    }

    fn refine(&self, index: u32, spacing_cap: f64, scratch: &mut Scratch) -> LeafPoint {
        let refined = self.noise.refine(
            index as usize,
            &self.neighborhoods,
            &self.sensor,
            spacing_cap,
            scratch,
        );
        LeafPoint { index, point: refined.point, spacing: refined.spacing, normal: refined.normal }
    }
}
