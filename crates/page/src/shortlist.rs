//! The views that a page shows of very many.

use crate::MOST_VIEWS;

/// Keeps the views that are the likeliest to collide, as they come one by one.
#[derive(Debug)]
pub struct Shortlist<T> {
    /// In the order in which they came, each with its upper bound.
    kept: Vec<(f64, T)>,
    passed: usize,
}

impl<T> Default for Shortlist<T> {
    fn default() -> Self {
        Self { kept: Vec::new(), passed: 0 }
    }
}

impl<T> Shortlist<T> {
    /// One more, whose probability is no larger than `upper`; of those equally likely the first stay.
    pub fn push(&mut self, upper: f64, view: T) {
        self.passed += 1;
        self.kept.push((upper, view));
        if self.kept.len() > MOST_VIEWS {
            let numbered = self.kept.iter().enumerate().rev();
            let least = numbered.min_by(|(_, (p, _)), (_, (q, _))| p.total_cmp(q));
            if let Some((index, _)) = least {
                self.kept.remove(index);
            }
        }
    }

    /// What was kept, in the order in which it came, and what is to be said of the rest.
    pub fn finish(self) -> (Vec<T>, Option<String>) {
        let (shown, all) = (self.kept.len(), self.passed);
        let note = (shown < all).then(|| {
            format!("{shown} of {all} poses are shown: those whose probability may be the largest.")
        });
        (self.kept.into_iter().map(|(_, view)| view).collect(), note)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_likeliest_stay_in_order_and_the_first_of_equals() {
        let mut list = Shortlist::default();
        let upper = |i: usize| if i % 5 == 4 { 0.9 } else { 0.1 };
        (0..2 * MOST_VIEWS).for_each(|i| list.push(upper(i), i));
        let (kept, note) = list.finish();
        assert_eq!(kept.len(), MOST_VIEWS);
        assert!(kept.is_sorted());
        let likely = (0..2 * MOST_VIEWS).filter(|i| i % 5 == 4);
        assert!(likely.clone().all(|i| kept.contains(&i)));
        let others = (0..2 * MOST_VIEWS).filter(|i| i % 5 != 4);
        assert!(others.take(MOST_VIEWS - likely.count()).all(|i| kept.contains(&i)));
        assert!(note.is_some_and(|note| note.starts_with("500 of 1000 poses are shown")));
        let mut few = Shortlist::default();
        few.push(0.5, 'a');
        assert_eq!(few.finish(), (vec!['a'], None));
    }
}
