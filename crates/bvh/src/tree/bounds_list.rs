//! Bounds on the refinement of primitives, which those of a leaf share.

use crate::LeafBounds;

/// No bounds.
const NONE: u32 = u32::MAX;

/// Bounds by index of primitive, each stored once for all that were given it together; those beyond the
/// list have none.
#[derive(Debug, Clone, Default)]
pub(crate) struct BoundsList {
    all: Vec<LeafBounds>,
    /// How many primitives have each of them.
    users: Vec<u32>,
    /// Those that none has any more, to be used again: of a cloud that changes for hours most would be.
    free: Vec<u32>,
    /// Which of them a primitive has.
    of: Vec<u32>,
}

impl BoundsList {
    pub(crate) fn get(&self, index: u32) -> Option<LeafBounds> {
        let which = *self.of.get(index as usize)?;
        self.all.get(which as usize).copied()
    }

    /// Gives these primitives, out of so many, the same bounds.
    pub(crate) fn set(&mut self, indices: &[u32], bounds: LeafBounds, count: usize) {
        self.of.resize(count, NONE);
        indices.iter().for_each(|&index| self.clear(index));
        let which = self.free.pop().unwrap_or_else(|| {
            self.all.push(bounds);
            self.users.push(0);
            self.all.len() as u32 - 1
        });
        (self.all[which as usize], self.users[which as usize]) = (bounds, indices.len() as u32);
        for &index in indices {
            self.of[index as usize] = which;
        }
    }

    pub(crate) fn clear(&mut self, index: u32) {
        let Some(which) = self.of.get_mut(index as usize).filter(|which| **which != NONE) else {
            return;
        };
        let which = std::mem::replace(which, NONE);
        let users = &mut self.users[which as usize];
        *users -= 1;
        if *users == 0 {
            self.free.push(which);
        }
    }

    /// Those of the primitives that had these indices before, in order.
    pub(crate) fn renumber(&mut self, before: &[Option<u32>]) {
        if self.all.is_empty() {
            return;
        }
        let which = |index: u32| self.of.get(index as usize).copied();
        self.of = before.iter().map(|index| index.and_then(which).unwrap_or(NONE)).collect();
        self.users.fill(0);
        for &which in self.of.iter().filter(|which| **which != NONE) {
            self.users[which as usize] += 1;
        }
        let is_free = |which: &u32| self.users[*which as usize] == 0;
        self.free = (0..self.users.len() as u32).filter(is_free).collect();
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
        // All that is used was gone through for each that is set, where each primitive has bounds of its own.
        assert_eq!(list.all.len(), 2, "what nobody has is not used again");
        let std = |list: &BoundsList| [0, 1, 2, 3, 4].map(|i| list.get(i).map(|b| b.std));
        assert_eq!(std(&list), [Some(0.5), Some(99.0), Some(99.0), Some(0.5), None]);
        list.clear(3);
        list.renumber(&[Some(1), None, Some(0), Some(3), Some(4)]);
        assert_eq!(std(&list), [Some(99.0), None, Some(0.5), None, None]);
        list.set(&[4], bounds(0.7), 5);
        list.set(&[1, 3], bounds(0.8), 5);
        list.set(&[0, 2], bounds(0.9), 5);
        assert_eq!(std(&list), [Some(0.9), Some(0.8), Some(0.9), Some(0.8), Some(0.7)]);
        assert_eq!(list.all.len(), 4);
    }
}
