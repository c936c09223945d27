//! The surface everywhere at once, and the tree fitted to it: for bodies that are queried often.

use cloudtouch_bvh::{NodeId, Primitive, Tree, TreeError};
use cloudtouch_geom::{Covariance, Point3, UncertainPoint, UnitVector3};
use cloudtouch_noise::Scratch;
use rayon::prelude::*;

use super::edge::DISC_SPACINGS;
use super::leaf::LeafSurface;
use super::slots::{Basis, Fitted};
use super::surfel::Surfel;
use crate::cloud::prepared::Prepared;
use crate::error::PrepareError;
use crate::stats::Stats;

/// The half axes of an ellipsoid, along a disc and across it, that holds everything up to (1, 1): the
/// sum of their inverse squares is less than one.
const HOLDS_BOTH: [f64; 2] = [1.1, 2.5];

impl Prepared {
    /// Computes the surface at every point, on all threads of the pool, and fits the tree to it.
    pub(in crate::cloud) fn refine(&mut self) -> Result<(), PrepareError> {
        let start = std::time::Instant::now();
        let leaves: Vec<NodeId> = self.tree.leaves().map(|leaf| leaf.id()).collect();
        let told = |scratch: &mut Scratch, &leaf: &NodeId| {
            let pieces = self.tree.leaf(leaf).map_or(&[][..], |leaf| leaf.primitive_indices());
            self.gather_around(pieces, scratch);
            LeafSurface::new(self.told_together(pieces, scratch), self.thin_side(leaf))
        };
        let told: Vec<_> = leaves.par_iter().map_init(Scratch::default, told).collect();
        for (leaf, told) in leaves.iter().zip(told) {
            self.surface.leaves.replace(leaf.index(), Box::new(told));
        }
        leaves.par_iter().for_each_init(Scratch::default, |scratch, &leaf| {
            self.leaf_edges(leaf, scratch);
        });
        // Every leaf has copies of its own.
        let mut fits = std::mem::take(&mut self.surface.fits);
        let of = |fitted: Box<Fitted>| fitted.basis.without_left();
        let basis = |piece| fits.take(piece).map_or(Basis::UNKNOWN, of);
        self.surface.bases = (0..self.surface.piece_count()).map(basis).collect();
        self.surface.fitted.take();
        self.tree = self.fitted_tree(Tree::set_extents)?;
        self.enclose_again();
        self.prepare_time += start.elapsed();
        Ok(())
    }

    /// The tree that a refined cloud has, for a query that comes by most of this one: kept, and counted
    /// among what it prepared. `None` where the time is over before the surface is known everywhere, or
    /// that is beyond what a tree holds.
    pub(crate) fn tree_fitted(
        &self,
        stats: &mut Stats,
        is_over: impl Fn() -> bool,
    ) -> Option<&Tree> {
        if self.surface.fitted.get().is_none() {
            // On this thread: whoever waits for others may be given another query to answer meanwhile, and
            // others may all wait for what is made here.
            let mut scratch = Scratch::default();
            for leaf in self.tree.leaves() {
                if is_over() {
                    return None;
                }
                let (_, computed) = self.leaf_surface(leaf.id(), &mut scratch);
                stats.leaves_prepared += usize::from(computed);
            }
            for leaf in self.tree.leaves() {
                if is_over() {
                    return None;
                }
                self.leaf_edges(leaf.id(), &mut scratch);
            }
        }
        let fitted = || self.fitted_tree(Tree::set_extents_on_this_thread).ok().map(Box::new);
        self.surface.fitted.get_or_init(fitted).as_deref()
    }

    /// The tree fitted to the surface everywhere, of which `set` takes the extents.
    fn fitted_tree(
        &self,
        set: impl FnOnce(&mut Tree, Vec<Covariance>) -> Result<(), TreeError>,
    ) -> Result<Tree, TreeError> {
        let pieces = self.surface.piece_count();
        let mut extents = vec![Covariance::zero(); pieces];
        let mut primitives =
            vec![Primitive::point(UncertainPoint::exact(Point3::origin())); pieces];
        let mut scratch = Scratch::default();
        for leaf in self.tree.leaves() {
            for (piece, primitive, extent) in self.primitives_of(leaf.id(), &mut scratch) {
                (primitives[piece as usize], extents[piece as usize]) = (primitive, extent);
            }
        }
        let mut tree = self.tree.clone();
        tree.refit(&primitives)?;
        set(&mut tree, extents)?;
        Ok(tree)
    }

    /// Encloses what the leaves hold along the sides that these have now.
    fn enclose_again(&mut self) {
        let ids: Vec<NodeId> = self.tree.leaves().map(|leaf| leaf.id()).collect();
        for id in ids {
            let thin = self.thin_side(id);
            if let Some(leaf) = self.surface.leaves.get_mut(id.index()) {
                **leaf = LeafSurface::new(std::mem::take(&mut leaf.surfels), thin);
            }
            if let Some(leaf) = self.surface.edges.get_mut(id.index()) {
                leaf.enclose(thin);
            }
        }
    }

    /// What the tree is to hold of the pieces of a leaf, once their surface is known, and how far that reaches.
    pub(in crate::cloud) fn primitives_of(
        &self,
        leaf: NodeId,
        scratch: &mut Scratch,
    ) -> Vec<(u32, Primitive, Covariance)> {
        let Some(node) = self.tree.leaf(leaf) else { return Vec::new() };
        let edges = self.near_halves(leaf, scratch);
        let surfels = self.ended_leaf(leaf, scratch);
        let of = |((&piece, surfel), edges): ((&u32, &Surfel), [f64; 2])| {
            (piece, Primitive::point(surfel.point), extent(surfel, edges))
        };
        node.primitive_indices().iter().zip(surfels).zip(edges).map(of).collect()
    }

    /// For each point of a leaf how far the near halves of its edges reach along its disc and across
    /// it, m.
    fn near_halves(&self, leaf: NodeId, scratch: &mut Scratch) -> Vec<[f64; 2]> {
        let surfels = self.leaf(leaf).0;
        let mut reach = vec![[0.0_f64; 2]; surfels.len()];
        for edge in self.leaf_edges(leaf, scratch).iter() {
            let half = 0.5 * (edge.ends[1] - edge.ends[0]);
            for place in edge.own_places() {
                let across = surfels[place].normal.map_or(0.0, |n| n.dot(&half).abs());
                let along = (half.norm_squared() - across * across).max(0.0).sqrt();
                let [known_along, known_across] = reach[place];
                reach[place] = [known_along.max(along), known_across.max(across)];
            }
        }
        reach
    }
}

/// An ellipsoid, as a covariance, that holds the disc of a piece of surface and the near halves of
/// its edges; nothing where no normal was fitted, for there is neither.
fn extent(surfel: &Surfel, [edges_along, edges_across]: [f64; 2]) -> Covariance {
    let Some(normal) = surfel.normal else { return Covariance::zero() };
    let [by_along, by_across] = HOLDS_BOTH;
    let along = (DISC_SPACINGS * surfel.spacing).max(by_along * edges_along);
    let across = by_across * edges_across;
    Covariance::from_axis(&UnitVector3::new_unchecked(normal), across, along)
}
