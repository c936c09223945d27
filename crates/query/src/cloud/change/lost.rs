//! Of a cloud that changes: where the surface may come out otherwise.

use std::collections::BTreeMap;

use cloudtouch_bvh::{NodeId, Patched};
use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_noise::Neighborhoods;
use rayon::prelude::*;

use crate::cloud::prepared::Prepared;
use crate::cloud::surface::slots::{Basis, LazySurface};
use crate::cloud::surface::surfel::Surfel;

/// Relative rounding of a distance, generously.
const ROUNDING: f64 = 1e-9;
/// The index of a point that is gone.
const GONE: u32 = u32::MAX;

/// The surface as it was, by the indices that points had.
pub(super) struct Before {
    pub surface: LazySurface,
    /// Of a refined cloud: the pieces of leaves that hold others now.
    pub moved_house: BTreeMap<u32, Surfel>,
    /// The index that each point has now.
    pub after: Vec<u32>,
}

impl Before {
    pub(super) fn basis(&self, piece: u32) -> Option<&Basis> {
        self.surface.basis(piece)
    }

    /// Of a piece of a leaf that holds others now.
    fn spacing(&self, piece: u32) -> Option<f64> {
        if self.surface.fits.is_empty() {
            return self.moved_house.get(&piece).map(|surfel| surfel.spacing);
        }
        self.surface.fits.get(piece as usize).map(|fitted| fitted.surfel.spacing)
    }
}

impl Prepared {
    /// The pieces whose surface is not known or may come out otherwise now, those of a leaf together.
    pub(super) fn lost(
        &self,
        old: &Before,
        before: &[Option<u32>],
        changed: &Neighborhoods,
        patched: &Patched,
    ) -> Vec<u32> {
        let mut is_new_leaf = vec![false; self.tree.node_slots()];
        patched.leaves.iter().for_each(|leaf| is_new_leaf[leaf.index()] = true);
        let points = self.points();
        let basis = |piece: u32| old.basis(before[piece as usize]?);
        let of_leaf = |leaf: NodeId| {
            let pieces = self.tree.leaf(leaf).map_or(&[][..], |leaf| leaf.primitive_indices());
            if pieces.iter().all(|&piece| basis(piece).is_none()) {
                return pieces.to_vec();
            }
            let places = || pieces.iter().map(|&piece| points[piece as usize]);
            let middle = Point3::from(
                places().map(|p| p.coords).sum::<Vector3>() / pieces.len().max(1) as f64,
            );
            let radius = places().map(|p| (p - middle).norm()).fold(0.0, f64::max);
            let reaches = pieces.iter().map(|&piece| basis(piece).map_or(0.0, |basis| basis.reach));
            let reach = radius + reaches.fold(0.0, f64::max);
            let is_new = is_new_leaf[leaf.index()];
            let is_near = is_new || may_change(&middle, reach, changed);
            let is_lost = |piece: u32| {
                let Some(basis) = basis(piece) else { return true };
                may_change(&points[piece as usize], basis.reach, changed)
                    || is_new && !self.is_within_caps(old, before, piece)
            };
            let is_unknown = |piece: u32| basis(piece).is_none();
            let lost = pieces.iter().copied();
            lost.filter(|&piece| if is_near { is_lost(piece) } else { is_unknown(piece) })
                .collect::<Vec<u32>>()
        };
        let leaves: Vec<NodeId> = self.tree.leaves().map(|leaf| leaf.id()).collect();
        leaves.par_iter().flat_map_iter(|&leaf| of_leaf(leaf)).collect()
    }

    /// Whether the limit to the spacing of a piece that is kept changes nothing.
    fn is_within_caps(&self, old: &Before, before: &[Option<u32>], piece: u32) -> bool {
        let cap = self.surface.cap(piece);
        before[piece as usize].is_some_and(|before| {
            let cap_before = old.surface.cap(before);
            is_within_caps([cap_before, cap], || old.spacing(before))
        })
    }
}

/// Whether what was computed about a place, looking so far (m), may come out otherwise.
pub(super) fn may_change(place: &Point3, reach: f64, changed: &Neighborhoods) -> bool {
    let reach = reach * (1.0 + ROUNDING);
    reach.is_infinite() || changed.is_any_within(place, reach)
}

/// Whether a spacing is the same under the limits of before and of now: these are equal, or neither acts.
pub(super) fn is_within_caps(
    [before, now]: [f64; 2],
    spacing: impl FnOnce() -> Option<f64>,
) -> bool {
    now == before || spacing().is_some_and(|spacing| spacing < before && spacing <= now)
}

/// By the indices of before, those that points have now.
pub(super) fn after(before: &[Option<u32>], count: usize) -> Vec<u32> {
    let mut after = vec![GONE; count];
    for (index, before) in (0..).zip(before) {
        if let Some(before) = before {
            after[*before as usize] = index;
        }
    }
    after
}
