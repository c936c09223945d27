//! Some of many, from all over them.

/// The fractional part of the golden ratio: its multiples leave out no part of a whole for long, whatever repeats in it.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// At most so many of as many indices in their order, all where there are no more. Files have their rows and columns, and
/// pairs in turn: of every so-manieth some would be left out altogether. Of each of as many equal parts it is one, at a
/// place of its own.
pub(crate) fn some_of(count: usize, most: usize) -> impl ExactSizeIterator<Item = usize> + Clone {
    let is_all = count <= most;
    let part = count as f64 / most as f64;
    let place = move |k: usize| {
        let share = (k as f64 * GOLDEN).fract();
        (((k as f64 + share) * part) as usize).min(count.saturating_sub(1))
    };
    (0..count.min(most)).map(move |k| if is_all { k } else { place(k) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_what_comes_in_turn_each_is_among_them_as_often() {
        for (count, most) in [(8_000, 500), (24_576, 4096), (100_001, 2000), (4097, 4096)] {
            for turn in [2, 3, 4, 6, 8, 16, 64] {
                let mut of = vec![0_usize; turn];
                some_of(count, most).for_each(|index| of[index % turn] += 1);
                let usual = most as f64 / turn as f64;
                let is_usual = |&of: &usize| (of as f64 - usual).abs() <= 1.0 + 0.25 * usual;
                assert!(of.iter().all(is_usual), "{count}, {most}, {turn}: {of:?}");
            }
        }
    }

    #[test]
    fn few_are_all_there_in_their_order() {
        assert_eq!(some_of(5, 5).collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
        assert_eq!(some_of(0, 5).len(), 0);
        let mut some: Vec<usize> = some_of(1000, 500).collect();
        some.dedup();
        assert!(some.len() > 450 && some.iter().all(|&index| index < 1000), "{}", some.len());
    }
}
