//! Wall times of calls, and how they are written.

use std::time::Instant;

use anyhow::Result;

use crate::report::Target;
use crate::statistics::{median, quantile};

/// What a call returns and how long it took, s.
pub(super) fn timed<T>(call: impl FnOnce() -> Result<T>) -> Result<(T, f64)> {
    let start = Instant::now();
    let value = call()?;
    Ok((value, start.elapsed().as_secs_f64()))
}

/// What the first call returns, and the least time of so many, s.
pub(super) fn least_of<T>(count: usize, mut call: impl FnMut() -> Result<T>) -> Result<(T, f64)> {
    let (value, mut least) = timed(&mut call)?;
    for _ in 1..count {
        least = least.min(timed(&mut call)?.1);
    }
    Ok((value, least))
}

/// The 95th percentile; NaN of nothing.
pub(super) fn p95(seconds: &[f64]) -> f64 {
    quantile(seconds, 0.95)
}

/// A time in the unit that suits it, with three digits.
pub(super) fn time(seconds: f64) -> String {
    match seconds {
        s if !s.is_finite() => "-".into(),
        s if s >= 0.9995 => format!("{} s", three_digits(s)),
        s if s >= 0.9995e-3 => format!("{} ms", three_digits(1e3 * s)),
        s => format!("{} µs", three_digits(1e6 * s)),
    }
}

/// A ratio of two times.
pub(super) fn ratio(value: f64) -> String {
    if value.is_finite() { format!("{} ×", three_digits(value)) } else { "-".into() }
}

/// A number with three digits that mean something.
pub(super) fn three_digits(value: f64) -> String {
    let digits = match value.abs() {
        size if size < 0.09995 => 3,
        size if size < 9.995 => 2,
        size if size < 99.95 => 1,
        _ => 0,
    };
    format!("{value:.digits$}")
}

/// That something takes so long at most, s.
pub(super) fn within(what: &str, seconds: f64, limit: f64) -> Target {
    Target::new(format!("{what} ≤ {}", time(limit)), time(seconds), seconds <= limit)
}

/// Median and 95th percentile, written.
pub(super) fn times(seconds: &[f64]) -> [String; 2] {
    [time(median(seconds)), time(p95(seconds))]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_the_unit_that_suits_them() {
        let written = [3.2e-7, 1.234e-5, 9.996e-4, 1.5e-2, 0.9999, 12.34].map(time);
        assert_eq!(written, ["0.32 µs", "12.3 µs", "1.00 ms", "15.0 ms", "1.00 s", "12.3 s"]);
        assert_eq!([time(f64::NAN), ratio(f64::NAN), ratio(0.0123)], ["-", "-", "0.012 ×"]);
    }
}
