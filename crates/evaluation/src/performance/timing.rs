//! Wall times of calls, and how they are written and drawn.

use std::time::Instant;

use anyhow::{Result, ensure};

use crate::{
    figure::Series,
    statistics::{median, quantile},
};

/// What a call returns and how long it took, s.
pub(super) fn timed<T>(call: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let value = call();
    (value, start.elapsed().as_secs_f64())
}

/// What the last of so many calls returns, and the least time of one, s.
pub(super) fn least_of<T>(count: usize, mut call: impl FnMut() -> Result<T>) -> Result<(T, f64)> {
    ensure!(count > 0, "nothing is to be timed");
    let (mut value, mut least) = timed(&mut call);
    for _ in 1..count {
        let (next, seconds) = timed(&mut call);
        (value, least) = (Ok(value.and(next)?), least.min(seconds));
    }
    Ok((value?, least))
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

/// Median and 95th percentile.
pub(super) fn times(seconds: &[f64]) -> [String; 2] {
    [time(median(seconds)), time(p95(seconds))]
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

/// The medians of lists of times (s) over x in milliseconds, with bars from the 5th to the 95th
/// percentile.
pub(super) fn curve(name: &str, lists: &[(usize, Vec<f64>)]) -> [Series; 2] {
    let at = |q: f64| lists.iter().map(move |(x, seconds)| (*x as f64, 1e3 * quantile(seconds, q)));
    let bars = at(0.05).zip(at(0.95)).map(|((x, low), (_, high))| (x, low, high));
    [Series::curve(name, at(0.5)), Series::whiskers(name, bars)]
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn times_have_the_unit_that_suits_them() {
        let written = [3.2e-7, 1.234e-5, 9.996e-4, 1.5e-2, 0.9999, 12.34].map(time);
        assert_eq!(written, ["0.32 µs", "12.3 µs", "1.00 ms", "15.0 ms", "1.00 s", "12.3 s"]);
        assert_eq!([time(f64::NAN), ratio(f64::NAN), ratio(0.0123)], ["-", "-", "0.012 ×"]);
        assert_eq!([9.996, 99.96, 123.4].map(three_digits), ["10.0", "100", "123"]);
    }

    #[test]
    fn the_least_time_counts_and_no_error_is_passed_over() {
        let mut naps = [9, 2, 5].into_iter();
        let mut nap = || {
            std::thread::sleep(Duration::from_millis(naps.next().unwrap()));
            Ok(naps.len())
        };
        let (last, seconds) = least_of(3, &mut nap).unwrap();
        assert!(last == 0 && (0.002..0.009).contains(&seconds), "{last} {seconds}");
        let mut calls = 0;
        let failing = || {
            calls += 1;
            ensure!(calls != 2, "the second fails");
            Ok(())
        };
        assert!(least_of(3, failing).is_err());
    }
}
