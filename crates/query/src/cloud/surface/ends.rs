//! Where a piece of surface ends at another face, what is known of it is less than what was fitted.

use cloudtouch_noise::{Face, Neighbor, Scratch};

use super::slots::BESIDE;
use super::surfel::Surfel;
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

    /// What is left of it as it was fitted, given the fits beside it.
    fn cut_off_by(&self, near: &[Face]) -> Self {
        let left = self.face().and_then(|own| own.cut_off(&self.point.covariance, near));
        let mut surfel = Self { is_cut_off: left.is_some(), ..*self };
        surfel.point.covariance = left.unwrap_or(surfel.point.covariance);
        surfel
    }
}

impl Prepared {
    /// The surface at one piece, as far as it goes.
    pub(in crate::cloud) fn told(&self, piece: u32, scratch: &mut Scratch) -> Surfel {
        let fit = *self.fit(piece, scratch);
        // What a refined cloud holds has ended.
        if self.is_refined() { fit } else { self.ended(piece, &fit, scratch) }
    }

    /// [`Self::told`] of some pieces near one another, of a cloud that is not refined.
    pub(super) fn told_together(&self, pieces: &[u32], scratch: &mut Scratch) -> Vec<Surfel> {
        let fits: Vec<Surfel> = pieces.iter().map(|&piece| *self.fit(piece, scratch)).collect();
        let beside = pieces.iter().filter_map(|&piece| self.basis(piece)?.beside.as_deref());
        let mut beside: Vec<u32> = beside.flatten().copied().collect();
        beside.sort_unstable();
        beside.dedup();
        let reach = pieces.iter().find_map(|&piece| self.known_reach(piece));
        self.gather(&beside, reach, scratch);
        pieces.iter().zip(&fits).map(|(&piece, fit)| self.ended(piece, fit, scratch)).collect()
    }

    /// What is left of a fit where it ends.
    pub(in crate::cloud) fn ended(
        &self,
        piece: u32,
        fit: &Surfel,
        scratch: &mut Scratch,
    ) -> Surfel {
        let Some(beside) = self.basis(piece).and_then(|basis| basis.beside.as_deref()) else {
            return *fit;
        };
        let others = beside.iter().filter(|&&other| other != piece);
        let near: Vec<Face> = others.filter_map(|&other| self.fit(other, scratch).face()).collect();
        fit.cut_off_by(&near)
    }

    /// The pieces beside one, just fitted, where some were measured off its plane, and how far it was looked
    /// for them and the fit, m; with fewer of them the piece itself fills the rest.
    pub(super) fn beside(
        &self,
        fit: &Surfel,
        piece: u32,
        reach: f64,
        scratch: &mut Scratch,
    ) -> (Option<Box<[u32; BESIDE]>>, f64) {
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
            let mut beside = Box::new([piece; BESIDE]);
            let others = found.iter().map(|other| other.index as u32);
            beside.iter_mut().zip(others).for_each(|(slot, other)| *slot = other);
            beside
        });
        (beside, reach.max(last))
    }
}
