//! The surface everywhere at once, and the tree fitted to it: for bodies that are queried often.

use cloudtouch_bvh::{NodeId, Primitive};
use cloudtouch_geom::{Covariance, Matrix3};
use cloudtouch_noise::Scratch;
use rayon::prelude::*;

use super::edge::{DISC_SPACINGS, Edge};
use super::{Cloud, Surfel};
use crate::error::PrepareError;

/// With this factor an ellipsoid over a disc holds the near halves of the edges at its middle too:
/// they are up to 1.1 of its 1.5 spacings long.
const EDGE_FACTOR: f64 = 1.5;

impl Cloud {
    /// Computes the surface at every point, on all threads of the pool, and fits the tree to it.
    ///
    /// A cloud as prepared computes its surface where queries come near it, and until then has to
    /// allow for what it might be; one that is refined is searched several times as fast, from the
    /// first query on. It takes as long as some tens of first queries, and pays for a scene that many
    /// poses are tested in, not for a frame that is looked at a few times. Probabilities stay what
    /// they are, only what is left out of the search and the bounds on it may differ.
    ///
    /// # Errors
    /// When the surface of a point is beyond what a tree holds, as at a noise of 1e50 m.
    pub fn refined(mut self) -> Result<Self, PrepareError> {
        let start = std::time::Instant::now();
        let leaves: Vec<NodeId> = self.tree.leaves().map(|leaf| leaf.id()).collect();
        leaves.par_iter().for_each(|&leaf| {
            self.leaf(leaf);
        });
        leaves.par_iter().for_each(|&leaf| {
            self.leaf_edges(leaf);
        });
        let mut extents = vec![Covariance::zero(); self.len()];
        for &leaf in &leaves {
            for (surfel, across) in self.leaf(leaf).0.iter().zip(self.edges_across(leaf)) {
                extents[surfel.index as usize] = extent(surfel, across);
            }
        }
        let mut scratch = Scratch::default();
        let primitives: Vec<Primitive> = (0..self.len() as u32)
            .map(|index| Primitive::point(self.surfel(index, &mut scratch).point))
            .collect();
        self.tree.clear_leaf_bounds();
        self.tree.refit(&primitives)?;
        self.tree.set_extents(extents)?;
        self.prepare_time += start.elapsed();
        Ok(self)
    }

    /// For each point of a leaf how far its edges rise from its disc up to their middles, m.
    fn edges_across(&self, leaf: NodeId) -> Vec<f64> {
        let surfels = self.leaf(leaf).0;
        let mut across = vec![0.0_f64; surfels.len()];
        for Edge { ends, own, .. } in self.leaf_edges(leaf) {
            for place in own.iter().flatten() {
                let rise = surfels[*place].normal.map_or(0.0, |n| n.dot(&(ends[1] - ends[0])));
                across[*place] = across[*place].max(0.5 * rise.abs());
            }
        }
        across
    }
}

/// An ellipsoid, as a covariance, that holds the disc of a piece of surface and the near halves of
/// its edges; nothing where no normal was fitted, for there is neither.
fn extent(surfel: &Surfel, across: f64) -> Covariance {
    let Some(normal) = surfel.normal else { return Covariance::zero() };
    let along = normal * normal.transpose();
    let [disc, across] = [DISC_SPACINGS * surfel.spacing, EDGE_FACTOR * across].map(|r| r * r);
    Covariance::from_symmetric(&((Matrix3::identity() - along) * disc + along * across))
}
