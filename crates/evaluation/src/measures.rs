//! Stand-in until the measures of the sweep are here.

/// Chance that a collision gets a higher probability than a free pair, ties counting half.
pub fn auc(scored: &[(f64, bool)]) -> f64 {
    let of = |kind| scored.iter().filter(move |s| s.1 == kind).map(|s| s.0);
    let (mut wins, mut pairs) = (0.0, 0.0);
    for hit in of(true) {
        for free in of(false) {
            pairs += 1.0;
            wins += if hit > free { 1.0 } else { f64::from(u8::from(hit == free)) * 0.5 };
        }
    }
    wins / pairs
}

/// Mean squared difference of probability and truth.
pub fn brier(scored: &[(f64, bool)]) -> f64 {
    let squares = scored.iter().map(|&(p, truth)| (p - f64::from(u8::from(truth))).powi(2));
    squares.sum::<f64>() / scored.len() as f64
}
