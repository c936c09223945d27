//! How steady a decision is while noise grows.

/// How often the decision `score >= threshold` changes from one answer to the next, in answers for
/// one pose under growing added noise.
///
/// A method that does not know says so with `None`: it then stays with its last decision.
pub(crate) fn flips(scores: &[Option<f64>], threshold: f64) -> usize {
    let decisions: Vec<bool> = scores.iter().flatten().map(|score| *score >= threshold).collect();
    decisions.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_changes_count() {
        let of = |scores: &[f64]| flips(&scores.iter().copied().map(Some).collect::<Vec<_>>(), 0.5);
        assert_eq!(of(&[]), 0);
        assert_eq!(of(&[0.9]), 0);
        assert_eq!(of(&[0.9, 0.5, 0.7]), 0);
        assert_eq!(of(&[0.9, 0.49, 0.7, 0.8, 0.1]), 3);
        assert_eq!(flips(&[Some(0.9), None, Some(0.8), None, Some(0.1)], 0.5), 1);
    }
}
