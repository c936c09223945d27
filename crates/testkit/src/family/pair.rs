//! The two bodies of a scene, for whoever looks for a path to contact.

use crate::{
    exact::{ExactMesh, Touch},
    poses::Approach,
};

/// Longer than any path to contact, m.
const LONGEST: f64 = 20.0;

/// The body that stays, the one that moves, and what counts as their contact.
#[derive(Clone, Copy)]
pub(super) struct Pair<'a> {
    pub(super) a: &'a ExactMesh,
    pub(super) b: &'a ExactMesh,
    pub(super) touch: Touch,
}

impl Pair<'_> {
    /// The path from a start on to contact; `None` when the start is not free, or nothing is ahead.
    pub(super) fn straight(&self, mut approach: Approach) -> Option<Approach> {
        if self.a.touches(self.b, &approach.pose(0.0), self.touch) {
            return None;
        }
        approach.advance(self.a, self.b, LONGEST).then_some(approach)
    }
}
