//! Where the surface goes on past the ends of an edge, in the frame of A.

use std::cell::OnceCell;

use cloudtouch_geom::Motion;

use crate::cloud::{Cloud, Edge, Onward};

/// Told when it is asked for, once.
#[derive(Debug)]
pub(in crate::search) struct Past<'a> {
    cloud: &'a Cloud,
    edge: &'a Edge,
    motion: Option<&'a Motion>,
    ends: [OnceCell<Onward>; 2],
}

impl<'a> Past<'a> {
    /// Of an edge that `motion` moved from where it was measured to the frame of A; none moved those of A.
    pub(in crate::search) fn new(
        cloud: &'a Cloud,
        edge: &'a Edge,
        motion: Option<&'a Motion>,
    ) -> Self {
        Self { cloud, edge, motion, ends: Default::default() }
    }

    /// Past its first end, or its second.
    pub(in crate::search) fn of(&self, end: usize) -> Onward {
        *self.ends[end].get_or_init(|| {
            let onward = self.cloud.onward(self.edge, end);
            self.motion.map_or(onward, |motion| onward.moved(motion))
        })
    }
}
