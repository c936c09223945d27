//! Pairs of nodes that wait, the most urgent first.

use std::cmp::Ordering;

/// A pair in a heap; the greatest comes out first: the least urgency, and of pairs that are as urgent
/// the one whose nodes are named first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Queued<T> {
    /// The urgency as a number of the same order as [`f64::total_cmp`]: heaps compare more than they do
    /// anything else.
    key: i64,
    a: u32,
    b: u32,
    pub(crate) item: T,
}

impl<T> Queued<T> {
    /// A pair of nodes; small is urgent.
    pub(crate) fn new(urgency: f64, (a, b): (u32, u32), item: T) -> Self {
        Self { key: turned(urgency.to_bits() as i64), a, b, item }
    }

    pub(crate) fn urgency(&self) -> f64 {
        f64::from_bits(turned(self.key) as u64)
    }

    pub(crate) fn nodes(&self) -> (u32, u32) {
        (self.a, self.b)
    }
}

/// Among the bits of negative numbers those of the larger ones are less; turned they are more. The same
/// again turns them back.
fn turned(bits: i64) -> i64 {
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

impl<T> Ord for Queued<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        (other.key, other.a, other.b).cmp(&(self.key, self.a, self.b))
    }
}

impl<T> PartialOrd for Queued<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> PartialEq for Queued<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<T> Eq for Queued<T> {}

#[cfg(test)]
mod tests {
    use std::collections::BinaryHeap;

    use super::*;

    #[test]
    fn pairs_come_by_urgency_and_then_by_name() {
        let urgencies =
            [3.0, -1.0, f64::INFINITY, -0.0, 0.0, -7.5, f64::MIN, 1e-300, 3.0, f64::NEG_INFINITY];
        let nodes = |i: usize| (9 - i as u32, i as u32);
        let queued = |(i, urgency): (usize, &f64)| Queued::new(*urgency, nodes(i), i);
        let mut heap: BinaryHeap<_> = urgencies.iter().enumerate().map(queued).collect();
        let mut expected: Vec<usize> = (0..urgencies.len()).collect();
        expected
            .sort_by(|&i, &j| urgencies[i].total_cmp(&urgencies[j]).then(nodes(i).cmp(&nodes(j))));
        for i in expected {
            let pair = heap.pop().unwrap();
            assert_eq!((pair.item, pair.nodes()), (i, nodes(i)));
            assert_eq!(pair.urgency().to_bits(), urgencies[i].to_bits());
        }
    }
}
