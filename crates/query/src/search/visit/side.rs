//! One of the two bodies of a search: how its leaves get to the frame of A, and memory for their fits.

use cloudtouch_geom::Motion;
use cloudtouch_noise::Scratch;

/// That of A by default.
#[derive(Debug, Default)]
pub(in crate::search) struct Side {
    /// From where it was measured to the frame of A; `None` for A.
    pub motion: Option<Motion>,
    scratch: Option<Box<Scratch>>,
}

impl Side {
    /// That of B.
    pub(in crate::search) fn moved(motion: Motion) -> Self {
        Self { motion: Some(motion), scratch: None }
    }

    /// Memory for fits, made for the first: most searches of clouds that were looked at before need none.
    pub(in crate::search) fn scratch(&mut self) -> &mut Scratch {
        self.scratch.get_or_insert_default()
    }
}
