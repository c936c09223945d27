//! Wall times of calls and how they are written.

use std::time::Instant;

use crate::common::statistics::quantile;

/// What a call returns and how long it took, s.
pub(super) fn timed<T>(call: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let value = call();
    (value, start.elapsed().as_secs_f64())
}

/// The median; NaN of nothing.
pub(super) fn median(seconds: &[f64]) -> f64 {
    quantile(seconds, 0.5)
}

/// The 95th percentile; NaN of nothing.
pub(super) fn p95(seconds: &[f64]) -> f64 {
    quantile(seconds, 0.95)
}

/// A time in the unit that suits it, with three digits.
pub(super) fn time(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "-".into();
    }
    let (value, unit) = [(1.0, "s"), (1e3, "ms"), (1e6, "µs")]
        .into_iter()
        .map(|(per_second, unit)| (seconds * per_second, unit))
        .find(|(value, _)| *value >= 0.9995)
        .unwrap_or((seconds * 1e6, "µs"));
    format!("{} {unit}", three_digits(value))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_the_unit_that_suits_them() {
        let written = [3.2e-7, 1.234e-5, 9.996e-4, 1.5e-2, 0.9999, 12.34].map(time);
        assert_eq!(written, ["0.32 µs", "12.3 µs", "1.00 ms", "15.0 ms", "1.00 s", "12.3 s"]);
        assert_eq!([time(f64::NAN), ratio(f64::NAN), ratio(0.0123)], ["-", "-", "0.012 ×"]);
        assert_eq!([9.996, 99.96, 123.4].map(three_digits), ["10.0", "100", "123"]);
    }

    #[test]
    fn a_call_takes_its_time() {
        let nap = std::time::Duration::from_millis(2);
        let ((), seconds) = timed(|| std::thread::sleep(nap));
        assert!(seconds >= nap.as_secs_f64());
    }
}
