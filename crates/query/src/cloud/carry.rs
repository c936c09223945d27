//! The surface of a changed cloud: where nothing changed that it depends on, it is kept.

use cloudtouch_geom::Point3;
use cloudtouch_noise::Neighborhoods;
use rayon::prelude::*;

use crate::error::PrepareError;

use super::prepared::Prepared;
use super::slots::Fitted;

/// Relative rounding of a distance, generously.
const ROUNDING: f64 = 1e-9;

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
        let is_uniform = |cloud: &Self| cloud.scans.noise.as_uniform().is_some();
        let has_normals = |cloud: &Self| cloud.scans.normals.is_some();
        if !(self.pieces.is_each() && of.pieces.is_each())
            || self.origin != of.origin
            || is_uniform(self) != is_uniform(of)
            || has_normals(self) != has_normals(of)
        {
            return Ok(0);
        }
        let changed = Neighborhoods::try_new(changed)?;
        let mut after = vec![0; of.len()];
        for (index, before) in (0..).zip(before) {
            before.iter().for_each(|&before| after[before as usize] = index);
        }
        let carried = (before.par_iter().enumerate()).filter(|&(piece, &before)| {
            let Some(before) = before else { return false };
            let fitted = of.known(before);
            let of_cap = |fitted: &Fitted| {
                let spacing = fitted.surfel.spacing;
                let [cap, cap_before] =
                    [&self.surface.spacing_caps[piece], &of.surface.spacing_caps[before as usize]];
                cap == cap_before || (spacing < *cap_before && spacing <= *cap)
            };
            let is_same = |fitted: &Fitted| {
                let reach = fitted.basis.reach * (1.0 + ROUNDING);
                !(reach.is_infinite() || changed.is_any_within(&self.points()[piece], reach))
            };
            let Some(mut fitted) = fitted.filter(of_cap).filter(is_same) else { return false };
            fitted.surfel.index = piece as u32;
            // None of them went.
            fitted.basis.nearest =
                fitted.basis.nearest.map(|nearest| nearest.map(|index| after[index as usize]));
            // A slot of a new cloud is empty.
            self.surface.surfels[piece].set(Box::new(fitted)).is_ok()
        });
        Ok(carried.count())
    }

    /// At how many points the surface was computed.
    pub(super) fn known_count(&self) -> usize {
        let pieces = 0..self.surface.spacing_caps.len() as u32;
        pieces.filter(|&piece| self.is_known(piece)).count()
    }
}
