//! Ranks of measured values, and shares.

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

/// The share of what holds, 0 to 1; NaN of nothing.
pub fn share(holds: impl IntoIterator<Item = bool>) -> f64 {
    let (mut held, mut all) = (0.0, 0.0);
    for holds in holds {
        held += f64::from(u8::from(holds));
        all += 1.0;
    }
    held / all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_known_lists() {
        let values: Vec<f64> = (1..=21).rev().map(f64::from).collect();
        assert_eq!([0.0, 0.5, 1.0].map(|q| quantile(&values, q)), [1.0, 11.0, 21.0]);
        assert_eq!(median(&[1.0, 4.0]), 2.5);
        assert!(median(&[]).is_nan());
    }
}
