//! Of a cloud that changes: the surface as it is now, what is kept of it and what is computed anew.

use std::collections::BTreeMap;

use cloudtouch_bvh::{NodeId, Patched};
use cloudtouch_noise::Scratch;
use rayon::prelude::*;

use super::lost::Before;
use crate::cloud::prepared::Prepared;
use crate::cloud::primitives::leaf_bounds;
use crate::cloud::surface::leaf::LeafSurface;
use crate::cloud::surface::slots::{Basis, Fitted};
use crate::cloud::surface::surfel::Surfel;
use crate::error::PrepareError;

impl Prepared {
    /// Takes over what is not lost; computes the rest at once in a refined cloud.
    pub(super) fn regrow(
        &mut self,
        old: Before,
        before: &[Option<u32>],
        patched: &Patched,
        lost: &[u32],
    ) -> Result<usize, PrepareError> {
        self.surface.fitted.take();
        let mut is_lost = vec![false; before.len()];
        lost.iter().for_each(|&piece| is_lost[piece as usize] = true);
        let renumbered = |basis: &Basis| Basis {
            nearest: basis.nearest.map(|near| near.map(|index| old.after[index as usize])),
            ..*basis
        };
        let kept = before.len() - lost.len();
        if old.surface.surfels.is_empty() {
            let unknown = Basis { reach: f64::INFINITY, nearest: None };
            let basis = |(index, before): (usize, &Option<u32>)| {
                let known = before.filter(|_| !is_lost[index]);
                known.and_then(|before| old.basis(before)).map_or(unknown, renumbered)
            };
            self.surface.bases = before.par_iter().enumerate().map(basis).collect();
            self.refit(&old.moved_house, before, patched, lost, &is_lost)?;
            return Ok(kept);
        }
        let mut surfels = old.surface.surfels;
        let carried = |(index, before): (usize, &Option<u32>)| {
            let before = before.filter(|_| !is_lost[index]);
            let fitted = before.and_then(|before| surfels[before as usize].take());
            fitted.map_or_else(Default::default, |mut fitted| {
                fitted.surfel.index = index as u32;
                fitted.basis = renumbered(&fitted.basis);
                fitted.into()
            })
        };
        self.surface.surfels = before.iter().enumerate().map(carried).collect();
        for leaf in self.with_other_edges(&is_lost) {
            self.surface.edges[leaf.index()].take();
            let pieces = self.tree.leaf(leaf).map_or(&[][..], |leaf| leaf.primitive_indices());
            if pieces.iter().any(|&piece| is_lost[piece as usize]) {
                self.surface.leaves[leaf.index()].take();
            }
        }
        let Self { noise, neighborhoods, scans, surface, tree, .. } = self;
        let measured = (&*noise, &*neighborhoods, &scans.noise);
        tree.set_bounds_of(&patched.leaves, |leaf| {
            let index = |piece: u32| piece as usize;
            leaf_bounds(leaf, surface.spacing_cap(leaf), index, measured)
        })?;
        Ok(kept)
    }

    /// Computes the surface of a refined cloud where it was lost, and fits the tree to it.
    fn refit(
        &mut self,
        moved_house: &BTreeMap<u32, Surfel>,
        before: &[Option<u32>],
        patched: &Patched,
        lost: &[u32],
        is_lost: &[bool],
    ) -> Result<(), PrepareError> {
        let fit = |scratch: &mut Scratch, &piece: &u32| (piece, self.fitted(piece, scratch));
        let fitted: Vec<(u32, Fitted)> = lost.par_iter().map_init(Scratch::default, fit).collect();
        let mut leaves = patched.leaves.clone();
        leaves.extend(lost.iter().filter_map(|&piece| self.tree.leaf_of(piece as usize)));
        leaves.sort_unstable();
        leaves.dedup();
        let fitted: BTreeMap<u32, Fitted> = fitted.into_iter().collect();
        for leaf in leaves {
            let Some(node) = self.tree.leaf(leaf) else { continue };
            let known = self.surface.leaves[leaf.index()].take();
            let known = known.map(|leaf| leaf.surfels).unwrap_or_default();
            let surfel = |(place, piece): (usize, &u32)| match fitted.get(piece) {
                Some(fitted) => Some(fitted.surfel),
                None => known.get(place).copied().or_else(|| {
                    let surfel = moved_house.get(&before[*piece as usize]?)?;
                    Some(Surfel { index: *piece, ..*surfel })
                }),
            };
            let surfels = node.primitive_indices().iter().enumerate().filter_map(surfel).collect();
            let surface = LeafSurface::new(surfels, self.thin_side(leaf));
            self.surface.leaves[leaf.index()] = Box::new(surface).into();
        }
        fitted.iter().for_each(|(&piece, fitted)| {
            self.surface.bases[piece as usize] = fitted.basis;
        });
        let leaves = self.with_other_edges(is_lost);
        leaves.iter().for_each(|leaf| drop(self.surface.edges[leaf.index()].take()));
        let amended: Vec<_> = (leaves.par_iter())
            .map_init(Scratch::default, |scratch, &leaf| {
                self.leaf_edges_with(leaf, scratch);
                self.primitives_of(leaf)
            })
            .flatten()
            .collect();
        self.tree.amend(&amended)?;
        Ok(())
    }

    /// The leaves that hold a piece of these, or one that has one of these among its nearest.
    fn with_other_edges(&self, is_lost: &[bool]) -> Vec<NodeId> {
        let is_other = |&piece: &u32| {
            is_lost[piece as usize]
                || self
                    .known_nearest(piece)
                    .is_none_or(|nearest| nearest.iter().any(|&near| is_lost[near as usize]))
        };
        let leaves: Vec<NodeId> = self.tree.leaves().map(|leaf| leaf.id()).collect();
        let has_other = |leaf: &NodeId| {
            self.tree.leaf(*leaf).is_some_and(|leaf| leaf.primitive_indices().iter().any(is_other))
        };
        leaves.into_par_iter().filter(has_other).collect()
    }
}
