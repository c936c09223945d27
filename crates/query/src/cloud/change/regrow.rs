//! Of a cloud that changes: the surface as it is now, what is kept of it and what is computed anew.

use std::collections::BTreeMap;

use cloudtouch_bvh::{NodeId, Patched};
use cloudtouch_noise::Scratch;
use rayon::prelude::*;

use super::lost::Before;
use crate::cloud::prepared::Prepared;
use crate::cloud::primitives::leaf_bounds;
use crate::cloud::surface::leaf::LeafSurface;
use crate::cloud::surface::room::Room;
use crate::cloud::surface::slots::{Basis, Fitted};
use crate::cloud::surface::surfel::{End, Surfel};
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
        let kept = before.len() - lost.len();
        if old.surface.fits.is_empty() {
            let basis = |(index, before): (usize, &Option<u32>)| {
                let known = before.filter(|_| !is_lost[index]);
                let known = known.and_then(|before| old.basis(before));
                known.map_or(Basis::UNKNOWN, |basis| basis.renumbered(&old.after))
            };
            self.surface.bases = before.par_iter().enumerate().map(basis).collect();
            self.refit(&old.moved_house, before, patched, lost, &is_lost)?;
            return Ok(kept);
        }
        let mut fits = old.surface.fits;
        self.surface.fits = Room::new(before.len());
        for (index, before) in before.iter().enumerate() {
            let before = before.filter(|_| !is_lost[index]);
            if let Some(mut fitted) = before.and_then(|before| fits.take(before as usize)) {
                fitted.surfel.index = index as u32;
                fitted.basis = fitted.basis.renumbered(&old.after);
                self.surface.fits.fill(index, fitted);
            }
        }
        for leaf in self.leaves_with(|piece| self.has_other_edges(piece, &is_lost)) {
            self.surface.edges.take(leaf.index());
        }
        for leaf in self.leaves_with(|piece| is_lost[piece as usize]) {
            self.surface.leaves.take(leaf.index());
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
        let mut found = BTreeMap::new();
        for (piece, fitted) in fitted {
            found.insert(piece, fitted.surfel);
            self.surface.bases[piece as usize] = fitted.basis;
        }
        let others = self.leaves_with(|piece| self.is_told_otherwise(piece, is_lost));
        let mut leaves = [&patched.leaves[..], &others].concat();
        leaves.sort_unstable();
        leaves.dedup();
        // A piece that may end elsewhere is as it was fitted first.
        let as_fitted = |scratch: &mut Scratch, &leaf: &NodeId| {
            let known = self.surface.leaves.get(leaf.index());
            let pieces = self.tree.leaf(leaf).map_or(&[][..], |leaf| leaf.primitive_indices());
            let mut surfel = |(place, &piece): (usize, &u32)| {
                let of_leaf = || known.and_then(|leaf| leaf.surfels.get(place)).copied();
                let of_other = || moved_house.get(&before[piece as usize]?).copied();
                let surfel = found.get(&piece).copied().or_else(of_leaf).or_else(of_other)?;
                let surfel = Surfel { index: piece, ..surfel };
                Some(match self.is_told_otherwise(piece, is_lost) {
                    true if surfel.end == End::CutOff => self.fitted(piece, scratch).surfel,
                    true => Surfel { end: self.basis(piece)?.end(), ..surfel },
                    false => surfel,
                })
            };
            let surfels = pieces.iter().enumerate().filter_map(&mut surfel).collect();
            LeafSurface::new(surfels, self.thin_side(leaf))
        };
        let surfaces: Vec<LeafSurface> =
            leaves.par_iter().map_init(Scratch::default, as_fitted).collect();
        for (leaf, surface) in leaves.iter().zip(surfaces) {
            self.surface.leaves.replace(leaf.index(), Box::new(surface));
        }
        self.end_again(&others, is_lost);
        let leaves = self.leaves_with(|piece| self.has_other_edges(piece, is_lost));
        leaves.iter().for_each(|leaf| drop(self.surface.edges.take(leaf.index())));
        let mut amended = [leaves, others].concat();
        amended.sort_unstable();
        amended.dedup();
        let amended: Vec<_> = (amended.par_iter())
            .map_init(Scratch::default, |scratch, &leaf| self.primitives_of(leaf, scratch))
            .flatten()
            .collect();
        self.tree.amend(&amended)?;
        Ok(())
    }

    /// Lets the pieces of some leaves of a refined cloud that are told otherwise end where they do now.
    fn end_again(&mut self, leaves: &[NodeId], is_lost: &[bool]) {
        let ended = |scratch: &mut Scratch, &leaf: &NodeId| -> Vec<(usize, Surfel)> {
            let pieces = self.tree.leaf(leaf).map_or(&[][..], |leaf| leaf.primitive_indices());
            let places = pieces.iter().enumerate();
            places
                .filter(|&(_, &piece)| self.is_told_otherwise(piece, is_lost))
                .map(|(place, &piece)| {
                    let fit = *self.fit(piece, scratch);
                    (place, self.ended(piece, &fit, scratch))
                })
                .collect()
        };
        let ended: Vec<_> = leaves.par_iter().map_init(Scratch::default, ended).collect();
        for (leaf, ended) in leaves.iter().zip(ended) {
            if let Some(surface) = self.surface.leaves.get_mut(leaf.index()) {
                ended.into_iter().for_each(|(place, surfel)| surface.surfels[place] = surfel);
            }
        }
    }

    /// Whether a piece is lost, or one of the fits that tell where it ends.
    fn is_told_otherwise(&self, piece: u32, is_lost: &[bool]) -> bool {
        let is_any_lost = |pieces: &[u32]| pieces.iter().any(|&near| is_lost[near as usize]);
        is_lost[piece as usize]
            || self.beside(piece).is_some_and(|beside| is_any_lost(&beside.pieces))
    }

    /// Whether a piece is lost, or one that is among its nearest.
    fn has_other_edges(&self, piece: u32, is_lost: &[bool]) -> bool {
        is_lost[piece as usize]
            || self
                .known_nearest(piece)
                .is_none_or(|nearest| nearest.iter().any(|&near| is_lost[near as usize]))
    }

    /// The leaves that hold a piece such as these.
    fn leaves_with(&self, is_one: impl Fn(u32) -> bool + Sync) -> Vec<NodeId> {
        let leaves: Vec<NodeId> = self.tree.leaves().map(|leaf| leaf.id()).collect();
        let has_one = |leaf: &NodeId| {
            let pieces = self.tree.leaf(*leaf).map_or(&[][..], |leaf| leaf.primitive_indices());
            pieces.iter().any(|&piece| is_one(piece))
        };
        leaves.into_par_iter().filter(has_one).collect()
    }
}
