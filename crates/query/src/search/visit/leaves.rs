//! The leaves of one body that a search came by.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use cloudtouch_bvh::NodeId;

/// Leaves, each loaded once.
#[derive(Debug)]
pub(crate) struct Leaves<L> {
    /// In the order in which they were first seen.
    seen: Vec<(NodeId, L)>,
    places: HashMap<usize, usize, BuildHasherDefault<Spread>>,
}

impl<L> Default for Leaves<L> {
    fn default() -> Self {
        Self { seen: Vec::new(), places: HashMap::default() }
    }
}

impl<L> Leaves<L> {
    pub(in crate::search) fn get_or_load(
        &mut self,
        id: NodeId,
        load: impl FnOnce() -> L,
    ) -> &mut L {
        let place = self.place(id, load);
        &mut self.seen[place].1
    }

    /// Where a leaf is among those seen, which is loaded where it is not.
    pub(super) fn place(&mut self, id: NodeId, load: impl FnOnce() -> L) -> usize {
        let Self { seen, places } = self;
        *places.entry(id.index()).or_insert_with(|| {
            seen.push((id, load()));
            seen.len() - 1
        })
    }

    pub(super) fn at(&self, place: usize) -> &L {
        &self.seen[place].1
    }

    pub(in crate::search) fn has(&self, id: NodeId) -> bool {
        self.places.contains_key(&id.index())
    }

    pub(in crate::search) fn len(&self) -> usize {
        self.seen.len()
    }

    /// In the order of the search.
    pub(in crate::search) fn all(&self) -> impl Iterator<Item = &L> {
        self.seen.iter().map(|(_, leaf)| leaf)
    }

    /// By the names of their nodes, whatever the order of the search.
    pub(crate) fn in_order(&self) -> impl Iterator<Item = &L> {
        let mut order: Vec<&(NodeId, L)> = self.seen.iter().collect();
        order.sort_unstable_by_key(|(id, _)| *id);
        order.into_iter().map(|(_, leaf)| leaf)
    }
}

/// Spreads the names of nodes, which nobody chooses to collide: a search looks two of them up for every pair.
#[derive(Debug, Default)]
struct Spread(u64);

impl Hasher for Spread {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_usize(usize::from(byte)));
    }

    fn write_usize(&mut self, name: usize) {
        // The golden ratio, in 64 bits.
        self.0 = (self.0 ^ name as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
