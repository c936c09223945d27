//! How likely a pair of nodes with disjoint boxes is descended, and the bound when it is not.

use cloudtouch_geom::normal;

/// How many standard deviations there are at least from a point to the mid-plane of a gap of δ ≥ 0
/// when its deviation across that plane is at most σ: δ/(2σ).
pub(crate) fn plane_deviations(gap: f64, std: f64) -> f64 {
    // A point on the plane is as likely on either side, however well it is known.
    if gap <= 0.0 { 0.0 } else { 0.5 * gap / std }
}

/// The gap from which on there are at least so many deviations to its mid-plane; infinite where no
/// gap is enough.
pub(crate) fn gap_of(deviations: f64, std: f64) -> f64 {
    const ROUNDING: f64 = 1e-12;
    let gap = 2.0 * std * deviations * (1.0 + ROUNDING);
    // Nothing known and nothing wanted multiply to NaN.
    if gap.is_nan() { f64::INFINITY } else { gap }
}

/// The largest probability to be beyond a plane so many deviations away; 1 for minus infinity, which
/// stands for no plane at all.
pub(crate) fn bound_at(deviations: f64) -> f64 {
    normal::upper_tail(deviations)
}

/// What decides about a node of a pair: 1 − P_cov, and its largest deviation along the gap.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Side {
    pub(crate) outside: f64,
    pub(crate) std: f64,
}

/// Probability of descending a pair of disjoint boxes under [`crate::Traversal::Paper`].
pub(crate) fn paper_probability(sides: [Side; 2]) -> f64 {
    either(sides.map(|side| side.outside))
}

/// Probability of descending a pair `gap` > 0 apart under [`crate::Traversal::GapAware`].
pub(crate) fn gap_aware_probability(gap: f64, sides: [Side; 2]) -> f64 {
    either(sides.map(|side| side.outside * 2.0 * normal::below_zero(gap, side.std)))
}

/// 1 − (1 − p)(1 − q) without the cancellation.
fn either([p, q]: [f64; 2]) -> f64 {
    p + q - p * q
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    #[test]
    fn gap_aware_starts_at_the_rule_of_the_paper_and_falls_off() {
        let sides = [Side { outside: 0.2, std: 0.01 }, Side { outside: 0.3, std: 0.02 }];
        let paper = paper_probability(sides);
        let aware = |gap| gap_aware_probability(gap, sides);
        assert!((paper - (1.0 - 0.8 * 0.7)).abs() < 1e-15);
        assert!((aware(0.0) - paper).abs() < 1e-15);
        assert!(aware(0.02) < 0.5 * paper && aware(0.02) > 0.0);
        assert!(aware(1.0) < 1e-300);
        let exact = [Side { outside: 0.0, std: 0.0 }; 2];
        assert_eq!(gap_aware_probability(0.01, exact), 0.0);
        assert_eq!(paper_probability(exact), 0.0);
    }

    #[test]
    fn bounds_of_touching_overlapping_and_exact_boxes() {
        let bound = |gap, std| bound_at(plane_deviations(gap, std));
        assert_eq!(bound_at(f64::NEG_INFINITY), 1.0);
        assert_eq!(bound(0.0, 0.01), 0.5);
        assert_eq!(bound(0.0, 0.0), 0.5);
        assert_eq!(bound(1e-9, 0.0), 0.0);
        assert_eq!(bound(1.0, f64::INFINITY), 0.5);
        assert!((bound(0.02, 0.01) - normal::cdf(-1.0)).abs() < 1e-15);
    }

    /// The claim of [`crate::Traversal::GapAware`]: the mean chance of crossing never exceeds
    /// `leak` when the gap is normal to a face. Random depths below the face and deviations.
    #[test]
    fn leak_bounds_the_mean_chance_to_cross_a_face() {
        for trial in 0..200 {
            let draw = |i, k| seed::unit(seed::derive(trial, i, k));
            let (gap, count) = (0.03 * draw(999, 0), 20);
            let (mut outside, mut crossing, mut largest) = (0.0, 0.0, 0.0_f64);
            for i in 0..count {
                let (depth, std) = (0.05 * draw(i, 1), 0.02 * draw(i, 2));
                outside += normal::upper_tail(depth / std) / count as f64;
                crossing += normal::upper_tail((depth + gap) / std) / count as f64;
                largest = largest.max(std);
            }
            let side = Side { outside, std: largest };
            let exact = Side { outside: 0.0, std: 0.0 };
            let leak = gap_aware_probability(gap, [side, exact]);
            assert!(crossing <= leak * (1.0 + 1e-12), "trial {trial}: {crossing} > {leak}");
        }
    }
}
