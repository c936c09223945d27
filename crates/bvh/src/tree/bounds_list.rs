//! Bounds on the refinement of primitives, which those of a leaf share.

use crate::LeafBounds;

/// No bounds.
const NONE: u32 = u32::MAX;

/// Bounds by index of primitive, each stored once for all that were given it together; those beyond the
/// list have none.
#[derive(Debug, Clone, Default)]
pub(crate) struct BoundsList {
    all: Vec<LeafBounds>,
    /// Which of them a primitive has.
    of: Vec<u32>,
}

impl BoundsList {
    pub(crate) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    pub(crate) fn get(&self, index: u32) -> Option<LeafBounds> {
        let which = *self.of.get(index as usize)?;
        self.all.get(which as usize).copied()
    }

    /// Gives these primitives, out of so many, the same bounds.
    pub(crate) fn set(&mut self, indices: &[u32], bounds: LeafBounds, count: usize) {
        if self.all.len() >= count.max(1) {
            self.forget_unused();
        }
        self.of.resize(count, NONE);
        let which = self.all.len() as u32;
        self.all.push(bounds);
        for &index in indices {
            self.of[index as usize] = which;
        }
    }

    pub(crate) fn clear(&mut self, index: u32) {
        if let Some(which) = self.of.get_mut(index as usize) {
            *which = NONE;
        }
    }

    /// Those of the primitives that had these indices before, in order.
    pub(crate) fn renumber(&mut self, before: &[Option<u32>]) {
        if !self.is_empty() {
            let which = |index: u32| self.of.get(index as usize).copied();
            self.of = before.iter().map(|index| index.and_then(which).unwrap_or(NONE)).collect();
        }
    }

    /// Drops what no primitive has any more: of a cloud that changes for hours most is.
    fn forget_unused(&mut self) {
        let mut place = vec![NONE; self.all.len()];
        let mut used = Vec::new();
        for which in self.of.iter_mut().filter(|which| **which != NONE) {
            let slot = &mut place[*which as usize];
            if *slot == NONE {
                *slot = used.len() as u32;
                used.push(self.all[*which as usize]);
            }
            *which = *slot;
        }
        self.all = used;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_stay_with_their_primitives_however_often_others_are_set() {
        let bounds = |std: f64| LeafBounds { std, shift: 0.0, reach: 0.0 };
        let mut list = BoundsList::default();
        list.set(&[0, 3], bounds(0.5), 5);
        for round in 0..100 {
            list.set(&[1, 2], bounds(f64::from(round)), 5);
        }
        assert!(list.all.len() <= 5, "{}", list.all.len());
        let std = |list: &BoundsList| [0, 1, 2, 3, 4].map(|i| list.get(i).map(|b| b.std));
        assert_eq!(std(&list), [Some(0.5), Some(99.0), Some(99.0), Some(0.5), None]);
        list.clear(3);
        list.renumber(&[Some(1), None, Some(0), Some(3), Some(4)]);
        assert_eq!(std(&list), [Some(99.0), None, Some(0.5), None, None]);
    }
}
