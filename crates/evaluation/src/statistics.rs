//! Ranks of measured values.

use statrs::statistics::{Data, OrderStatistics};

/// The value below which the share `q` of the values lies, interpolated between neighbours; NaN of
/// nothing.
pub fn quantile(values: &[f64], q: f64) -> f64 {
    Data::new(values.to_vec()).quantile(q)
}

/// The value in the middle; NaN of nothing.
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}
