//! Pairs of nodes that wait, the most urgent first.

use std::cmp::Ordering;

/// How urgent a pair of nodes is.
pub(crate) trait Urgent {
    /// Small is urgent.
    fn urgency(&self) -> f64;

    /// The nodes: of pairs that are as urgent the one named first comes first.
    fn nodes(&self) -> (u32, u32);
}

/// A pair in a heap; the greatest comes out first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Queued<T>(pub(crate) T);

impl<T: Urgent> Ord for Queued<T> {
    fn cmp(&self, Self(other): &Self) -> Ordering {
        let Self(pair) = self;
        (other.urgency().total_cmp(&pair.urgency())).then_with(|| other.nodes().cmp(&pair.nodes()))
    }
}

impl<T: Urgent> PartialOrd for Queued<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T: Urgent> PartialEq for Queued<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<T: Urgent> Eq for Queued<T> {}
