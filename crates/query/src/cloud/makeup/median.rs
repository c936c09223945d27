//! What half of some values are above.

/// The middle one of values in order, the upper of two; 0 of none.
pub(in crate::cloud) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    values.sort_unstable_by(f64::total_cmp);
    values.get(middle).copied().unwrap_or(0.0)
}
