//! Where a piece of surface ends at another face, what is known of it is less than what was fitted.

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::{Covariance, UncertainPoint};
use cloudtouch_noise::{Face, Neighbor, Scratch};

use super::slots::{BESIDE, Beside};
use super::surfel::{End, Surfel};
use crate::cloud::prepared::Prepared;

/// A point so many spacings off a piece may be of another face ...
const OFF_SPACINGS: f64 = 0.3;
/// ... where there are so many of them.
const LEAST_OFF: usize = 2;

impl Surfel {
    /// The piece as those beside it see it; `None` where no normal was fitted.
    fn face(&self) -> Option<Face> {
        let place = self.point.mean;
        self.normal.map(|normal| Face { place, normal, across: self.across })
    }

    /// The piece with what is left of it where it ends; none where it ends nowhere.
    fn with(self, left: Option<&Covariance>) -> Self {
        let Some(&covariance) = left else { return Self { end: End::Nowhere, ..self } };
        Self { end: End::CutOff, point: UncertainPoint { covariance, ..self.point }, ..self }
    }
}

impl Prepared {
    /// The surface at one piece, as far as it goes.
    pub(crate) fn told(&self, piece: u32, scratch: &mut Scratch) -> Surfel {
        let fit = *self.fit(piece, scratch);
        self.ended(piece, &fit, scratch)
    }

    /// [`Self::told`] of some pieces near one another.
    pub(crate) fn told_together(&self, pieces: &[u32], scratch: &mut Scratch) -> Vec<Surfel> {
        let fits: Vec<Surfel> = pieces.iter().map(|&piece| *self.fit(piece, scratch)).collect();
        let open = pieces.iter().zip(&fits).filter(|(_, fit)| fit.end == End::Open);
        let beside = open.filter_map(|(&piece, _)| self.beside(piece));
        let unknown = beside.filter(|beside| beside.left.get().is_none());
        let mut unknown: Vec<u32> = unknown.flat_map(|beside| beside.pieces).collect();
        unknown.sort_unstable();
        unknown.dedup();
        let reach = pieces.iter().find_map(|&piece| self.known_reach(piece));
        self.gather(&unknown, reach, scratch);
        pieces.iter().zip(&fits).map(|(&piece, fit)| self.ended(piece, fit, scratch)).collect()
    }

    /// What is left of a fit where it ends.
    pub(in crate::cloud) fn ended(
        &self,
        piece: u32,
        fit: &Surfel,
        scratch: &mut Scratch,
    ) -> Surfel {
        let Some(beside) = self.beside(piece).filter(|_| fit.end == End::Open) else { return *fit };
        let left = || {
            let others = beside.pieces.iter().filter(|&&other| other != piece);
            let near: Vec<Face> =
                others.filter_map(|&other| self.fit(other, scratch).face()).collect();
            let left = fit.face().and_then(|own| own.cut_off(&fit.point.covariance, &near));
            left.map(Box::new)
        };
        fit.with(beside.left.get_or_init(left).as_deref())
    }

    /// The surface at the points of a leaf as far as it goes, where all of it was told.
    pub(crate) fn known_ended(&self, id: NodeId) -> Option<&[Surfel]> {
        self.known_leaf(id)?.ended.get().map(|surfels| &surfels[..])
    }

    /// The surface at the points of a leaf as far as it goes.
    pub(crate) fn ended_leaf(&self, id: NodeId, scratch: &mut Scratch) -> &[Surfel] {
        let (leaf, _) = self.leaf_surface(id, scratch);
        if self.is_refined() {
            return &leaf.surfels;
        }
        leaf.ended.get_or_init(|| {
            let pieces = self.tree.leaf(id).map_or(&[][..], |leaf| leaf.primitive_indices());
            self.told_together(pieces, scratch)
        })
    }

    /// The pieces about one that may end there.
    pub(in crate::cloud) fn beside(&self, piece: u32) -> Option<&Beside> {
        self.basis(piece)?.beside.as_deref()
    }

    /// The pieces beside one, just fitted, where some were measured off its plane, and how far it was looked
    /// for them and the fit, m; with fewer of them the piece itself fills the rest.
    pub(super) fn look_beside(
        &self,
        fit: &Surfel,
        piece: u32,
        reach: f64,
        scratch: &mut Scratch,
    ) -> (Option<Box<Beside>>, f64) {
        let Some(normal) = fit.normal else { return (None, reach) };
        let near = self.near_pieces();
        let found = match &self.scans.normals {
            None => self.found_by_fit(scratch),
            Some(_) => near.nearest_with(piece as usize, BESIDE, scratch),
        };
        let found = &found[..found.len().min(BESIDE)];
        let is_off = |other: &&Neighbor| {
            let height = normal.dot(&(near.points()[other.index] - fit.point.mean));
            height.abs() > OFF_SPACINGS * fit.spacing
        };
        let last = found.get(BESIDE - 1).map_or(f64::INFINITY, |l| l.squared_distance.sqrt());
        let is_beside = found.iter().filter(is_off).count() >= LEAST_OFF;
        let beside = is_beside.then(|| {
            let mut beside = [piece; BESIDE];
            let others = found.iter().map(|other| other.index as u32);
            beside.iter_mut().zip(others).for_each(|(slot, other)| *slot = other);
            Beside::new(beside)
        });
        (beside, reach.max(last))
    }
}
