//! The bias: Σ C(y − cb)₊ as a function of b alone, piecewise linear and convex.

/// Σ C(y − cb)₊ over b, by the places where its slope changes.
#[derive(Debug, Default)]
pub(crate) struct Slack {
    /// cy and C of every point, in the order of cy.
    breaks: Vec<(f64, f64)>,
    /// Minus the slope before the first of them: Σ C over class A.
    start: f64,
}

/// Slopes this small beside the steepest are sums of penalties that cancel.
const ROUNDING: f64 = 1e-12;

impl Slack {
    /// Takes c, y and C of every point.
    pub(crate) fn set(&mut self, points: impl Iterator<Item = (f64, f64, f64)>) {
        self.breaks.clear();
        self.start = 0.0;
        for (sign, y, penalty) in points {
            self.breaks.push((sign * y, penalty));
            self.start += if sign > 0.0 { penalty } else { 0.0 };
        }
        self.breaks.sort_unstable_by(|l, r| l.0.total_cmp(&r.0));
    }

    /// The minimiser; the middle where the minimum is flat.
    pub(crate) fn minimiser(&self) -> f64 {
        let mut slope = -self.start;
        for (rank, &(at, penalty)) in self.breaks.iter().enumerate() {
            slope += penalty;
            if slope.abs() <= ROUNDING * self.start {
                return self.breaks.get(rank + 1).map_or(at, |next| 0.5 * (at + next.0));
            }
            if slope > 0.0 {
                return at;
            }
        }
        self.breaks.last().map_or(0.0, |last| last.0)
    }

    /// The interval around the minimiser `bias` on which the function exceeds its minimum by `rise`
    /// at most.
    pub(crate) fn within(&self, rise: f64, bias: f64) -> [f64; 2] {
        let below = self.breaks.partition_point(|entry| entry.0 <= bias);
        let (left, right) = self.breaks.split_at(below);
        let passed: f64 = left.iter().map(|entry| entry.1).sum();
        // At the minimiser itself a break, or several, may lie: those count to neither side.
        let here: f64 =
            left.iter().rev().take_while(|entry| entry.0 == bias).map(|entry| entry.1).sum();
        let highest =
            bias + reach(rise, passed - self.start, right.iter().map(|e| (e.0 - bias, e.1)));
        let left = left.iter().rev().skip_while(|entry| entry.0 == bias);
        let lowest =
            bias - reach(rise, self.start - passed + here, left.map(|e| (bias - e.0, e.1)));
        [lowest, highest]
    }
}

/// How far one may go until a function has risen by `rise`, from a slope that changes by each second
/// at each first.
fn reach(rise: f64, mut slope: f64, changes: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut at, mut risen) = (0.0, 0.0);
    for (next, change) in changes {
        let more = slope.max(0.0) * (next - at);
        if risen + more > rise {
            break;
        }
        (at, risen) = (next, risen + more);
        slope += change;
    }
    if slope > 0.0 { at + (rise - risen) / slope } else { at }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn value(points: &[(f64, f64, f64)], bias: f64) -> f64 {
        points.iter().map(|(sign, y, penalty)| penalty * (y - sign * bias).max(0.0)).sum()
    }

    proptest! {
        #[test]
        fn the_minimiser_is_least_and_the_interval_ends_where_the_rise_does(
            points in prop::collection::vec((any::<bool>(), -3.0..3.0_f64, 1..4_u8), 2..12),
            rise in 0.0..5.0_f64,
        ) {
            let mut points: Vec<(f64, f64, f64)> = points
                .into_iter()
                .map(|(a, y, penalty)| (if a { 1.0 } else { -1.0 }, y, f64::from(penalty)))
                .collect();
            (points[0].0, points[1].0) = (1.0, -1.0);
            let mut slack = Slack::default();
            slack.set(points.iter().copied());
            let bias = slack.minimiser();
            let least = value(&points, bias);
            for k in -60..=60 {
                prop_assert!(value(&points, 0.1 * f64::from(k)) >= least - 1e-9);
            }
            for (end, outwards) in slack.within(rise, bias).into_iter().zip([-1.0, 1.0]) {
                prop_assert!((end - bias) * outwards >= 0.0);
                prop_assert!((value(&points, end) - least - rise).abs() < 1e-9);
                // Beyond it the function has risen by more.
                prop_assert!(value(&points, end + 1e-3 * outwards) > least + rise);
            }
        }
    }
}
