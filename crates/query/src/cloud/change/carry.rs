//! The surface of a changed cloud: where nothing changed that it depends on, it is kept.

use cloudtouch_geom::Point3;
use cloudtouch_noise::Neighborhoods;
use rayon::prelude::*;

use super::lost::{after, is_within_caps, may_change};
use crate::cloud::prepared::Prepared;
use crate::cloud::surface::slots::Fitted;
use crate::error::PrepareError;

impl Prepared {
    /// Takes the surface of a cloud for this one, which it became, where it was computed and would come
    /// out the same to the bit; says at how many points. `before` has the index that each point had, if any, and
    /// `changed` the places (local frame, m) that points left, came to or moved between.
    pub(super) fn carry_over(
        &self,
        of: &Self,
        before: &[Option<u32>],
        changed: Vec<Point3>,
    ) -> Result<usize, PrepareError> {
        // Where a few points stand for all, which they are hangs on all.
        if !(self.pieces.is_each() && of.pieces.is_each())
            || self.origin != of.origin
            || !self.scans.is_like(&of.scans)
        {
            return Ok(0);
        }
        // PERF: an index of all that changed takes as long as one of the cloud, and most frames keep nothing known.
        if !before.iter().flatten().any(|&before| of.is_known(before)) {
            return Ok(0);
        }
        let changed = Neighborhoods::new(changed)?;
        let after = after(before, of.len());
        let carried = (before.par_iter().enumerate()).filter(|&(piece, &before)| {
            let Some(before) = before else { return false };
            let fitted = of.known(before);
            let of_cap = |fitted: &Fitted| {
                let caps = [of.surface.cap(before), self.surface.cap(piece as u32)];
                is_within_caps(caps, || Some(fitted.surfel.spacing))
            };
            let is_same =
                |fitted: &Fitted| !may_change(&self.points()[piece], fitted.basis.reach, &changed);
            let Some(mut fitted) = fitted.filter(of_cap).filter(is_same) else { return false };
            fitted.surfel.index = piece as u32;
            // None of them went.
            fitted.basis = fitted.basis.renumbered(&after);
            // A slot of a new cloud is empty.
            self.surface.fits.fill(piece, Box::new(fitted))
        });
        Ok(carried.count())
    }

    /// At how many points the surface was computed.
    pub(super) fn known_count(&self) -> usize {
        let pieces = 0..self.surface.piece_count() as u32;
        pieces.filter(|&piece| self.is_known(piece)).count()
    }
}
