//! Pieces of a leaf that something is near, which tells whether they end before it.
//!
//! Where a piece ends takes the fits of those beside it, most of what a first query costs. As fitted it is
//! never known better than where it has ended, so that what is too far from it as fitted is too far.

use crate::cloud::Surfel;

use super::leaf::NoisyLeaf;
use super::side::Side;

/// Rounding of deviations, by which they may be more as fitted, relative, generously.
pub(in crate::search) const ROUNDING: f64 = 1e-9;

impl NoisyLeaf<'_> {
    /// Lets all pieces end.
    pub(in crate::search) fn end_all(&mut self, side: &mut Side) {
        if self.may_end {
            let ended = self.cloud.prepared().ended_leaf(self.id, side.scratch()).iter();
            self.surfels = match &side.motion {
                None => ended.copied().collect(),
                Some(motion) => ended.map(|surfel| surfel.moved(motion)).collect(),
            };
            self.may_end = false;
        }
    }

    /// Lets those pieces end that something is near as they were fitted, by their places, after which nothing
    /// is near those where that is open.
    pub(in crate::search) fn end_near(
        &mut self,
        mut is_near: impl FnMut(&Self, usize) -> bool,
        side: &mut Side,
    ) {
        if !self.may_end {
            return;
        }
        let open = (0..self.surfels.len()).filter(|&place| self.surfels[place].may_end());
        let near: Vec<usize> = open.filter(|&place| is_near(self, place)).collect();
        if near.is_empty() {
            return;
        }
        let cloud = self.cloud;
        let pieces = cloud.tree().leaf(self.id).map_or(&[][..], |leaf| leaf.primitive_indices());
        let pieces: Vec<u32> = near.iter().map(|&place| pieces[place]).collect();
        let told = cloud.prepared().told_together(&pieces, side.scratch());
        let surfels = self.surfels.to_mut();
        for (place, surfel) in near.into_iter().zip(told) {
            surfels[place] = side.motion.map_or(surfel, |motion| surfel.moved(&motion));
            if let Some(whitening) = self.whitenings.get_mut(place) {
                whitening.take();
            }
        }
        self.may_end = self.surfels.iter().any(Surfel::may_end);
    }
}
