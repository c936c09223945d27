//! Room for values by number, of which most are never computed.

use std::sync::OnceLock;

use rayon::prelude::*;

/// So many side by side share what it takes to have room at all.
const TOGETHER: usize = 16;

/// A value for each number, each computed once. There is room for one when it, or one beside it, is asked for: most
/// clouds are asked about in few places.
#[derive(Debug)]
pub(in crate::cloud) struct Room<T> {
    blocks: Vec<OnceLock<Box<[OnceLock<T>; TOGETHER]>>>,
    count: usize,
}

impl<T> Default for Room<T> {
    fn default() -> Self {
        Self::new(0)
    }
}

impl<T> Room<T> {
    /// For so many values.
    pub(in crate::cloud) fn new(count: usize) -> Self {
        let mut room = Self { blocks: Vec::new(), count: 0 };
        room.set_count(count);
        room
    }

    /// Whether it is for none.
    pub(in crate::cloud) fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Makes it one for so many values, of which those there are stay.
    pub(in crate::cloud) fn set_count(&mut self, count: usize) {
        (count..self.count).for_each(|number| drop(self.take(number)));
        self.blocks.resize_with(count.div_ceil(TOGETHER), OnceLock::new);
        self.count = count;
    }

    /// A value that was computed.
    pub(in crate::cloud) fn get(&self, number: usize) -> Option<&T> {
        self.blocks.get(number / TOGETHER)?.get()?[number % TOGETHER].get()
    }

    /// A value, computed where it was not.
    ///
    /// # Panics
    /// Where there is no room for it.
    pub(in crate::cloud) fn get_or_init(&self, number: usize, compute: impl FnOnce() -> T) -> &T {
        self.slot(number).get_or_init(compute)
    }

    /// Keeps a value where there is none; whether there was none.
    ///
    /// # Panics
    /// Where there is no room for it.
    pub(in crate::cloud) fn fill(&self, number: usize, value: T) -> bool {
        self.slot(number).set(value).is_ok()
    }

    /// Keeps a value in the place of what there is.
    ///
    /// # Panics
    /// Where there is no room for it.
    pub(in crate::cloud) fn replace(&mut self, number: usize, value: T) {
        self.take(number);
        self.fill(number, value);
    }

    pub(in crate::cloud) fn get_mut(&mut self, number: usize) -> Option<&mut T> {
        self.blocks.get_mut(number / TOGETHER)?.get_mut()?[number % TOGETHER].get_mut()
    }

    pub(in crate::cloud) fn take(&mut self, number: usize) -> Option<T> {
        self.blocks.get_mut(number / TOGETHER)?.get_mut()?[number % TOGETHER].take()
    }

    /// All values that were computed, on all threads of the pool.
    pub(in crate::cloud) fn par_iter_mut(&mut self) -> impl ParallelIterator<Item = &mut T>
    where
        T: Send + Sync,
    {
        let blocks = self.blocks.par_iter_mut().filter_map(OnceLock::get_mut);
        blocks.flat_map_iter(|block| block.iter_mut().filter_map(OnceLock::get_mut))
    }

    fn slot(&self, number: usize) -> &OnceLock<T> {
        assert!(number < self.count, "value {number} of {}", self.count);
        let block = self.blocks[number / TOGETHER].get_or_init(Box::default);
        &block[number % TOGETHER]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_computed_once_and_stay_where_they_are_as_room_grows() {
        let mut room = Room::new(TOGETHER + 1);
        assert_eq!(*room.get_or_init(TOGETHER, || 7), 7);
        assert_eq!(*room.get_or_init(TOGETHER, || 8), 7);
        assert!(room.fill(3, 5) && !room.fill(3, 6));
        assert_eq!(
            [2, 3, TOGETHER].map(|number| room.get(number).copied()),
            [None, Some(5), Some(7)]
        );
        room.set_count(5 * TOGETHER);
        room.replace(4 * TOGETHER, 1);
        room.par_iter_mut().for_each(|value| *value += 1);
        let known: Vec<i32> = (0..5 * TOGETHER).filter_map(|number| room.take(number)).collect();
        assert_eq!(known, [6, 8, 2]);
    }

    #[test]
    fn there_is_nothing_where_room_was_given_up() {
        let mut room = Room::new(TOGETHER);
        room.fill(9, 1);
        room.set_count(9);
        room.set_count(TOGETHER);
        assert_eq!([9, TOGETHER].map(|number| room.get(number)), [None, None]);
        assert_eq!(room.get_mut(3 * TOGETHER), None);
    }

    #[test]
    #[should_panic(expected = "value 16 of 16")]
    fn no_room_beyond_the_last() {
        Room::new(TOGETHER).get_or_init(TOGETHER, || 1);
    }
}
