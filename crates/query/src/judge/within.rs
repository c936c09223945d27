//! How likely two bodies are within a margin of each other.

use super::grid::Grid;

/// Where the log odds have their values: deviations from being within the margin.
pub const WITHIN_KNOTS: [f64; 9] = [-6.0, -2.5, -1.2, -0.4, 0.4, 1.2, 2.3, 4.0, 6.0];

/// For which noise over spacing there are such values: of many blurred pieces one is near by chance.
pub const WITHIN_NOISES: [f64; 3] = [0.0, 0.5, 2.0];

/// Made by `cargo xtask motion --draws 3 --poses 20 --fit`, on generated scenes at margins of 1, 3 and 10 cm.
const WITHIN: [[f64; 9]; WITHIN_NOISES.len()] = [
    [14.137, 7.23, 4.726, 3.895, 1.676, -0.998, -3.089, -6.65, -10.95],
    [13.187, 6.429, 3.632, 2.148, 0.028, -2.098, -4.158, -7.43, -11.366],
    [10.287, 4.22, 2.693, 1.689, -2.854, -5.445, -7.394, -9.79, -12.602],
];

/// A margin of this share of a spacing counts half: one much narrower is as good as none, and what
/// tells of a collision, surfaces that cross, tells of it.
const HALF_SPACINGS: f64 = 0.1;

/// Log odds of being within a margin (m) so many deviations away, of bodies that scatter by so much noise over spacing and
/// whose samples are `spacing` (m) apart; never less than those of a collision by the same deviations. Continuous, and
/// rising with the margin.
pub(crate) fn log_odds_within(
    deviations: f64,
    margin: f64,
    (scatter_over_spacing, spacing): (f64, f64),
    collision: f64,
) -> f64 {
    let grid = Grid { rows: &WITHIN_NOISES, columns: &WITHIN_KNOTS, values: &WITHIN };
    let alone = grid.at(scatter_over_spacing, deviations);
    // Exact bodies have no spacing: any margin counts in full.
    let share = margin / (margin + HALF_SPACINGS * spacing);
    collision + share * (alone - collision).max(0.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn no_margin_is_a_collision_and_values_fall_with_deviations() {
        assert_eq!(log_odds_within(0.3, 0.0, (0.5, 0.02), -1.5), -1.5);
        for of_noise in WITHIN {
            assert!(of_noise.is_sorted_by(|a, b| a >= b));
        }
        assert!(log_odds_within(0.4, 0.02, (0.2, 0.0), -1.5) > 0.0);
        let blurred = [0.0, 0.5, 2.0].map(|noise| log_odds_within(0.8, 0.03, (noise, 0.0), -9.0));
        assert!(blurred.is_sorted_by(|a, b| a > b), "{blurred:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn a_larger_margin_is_never_less_likely(
            noise in 0.0..4.0_f64, z in -7.0..7.0_f64, m in 1e-6..0.5_f64, spacing in 0.0..0.1_f64, collision in -9.0..9.0_f64,
            step in (0.0..2.0_f64, 0.0..0.1_f64, 0.0..2.0_f64),
        ) {
            let less = log_odds_within(z, m, (noise, spacing), collision);
            let more = log_odds_within(z - step.0, m + step.1, (noise, spacing), collision + step.2);
            prop_assert!(more >= less - 1e-12);
        }
    }
}
