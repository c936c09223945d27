//! The judge for the noise of one pair of bodies.

use super::grid::{Grid, between_knots};
use super::knots::{
    CROSSING_KNOTS, DEVIATION_KNOTS, DOUBT_KNOTS, EXTENT_KNOTS, EXTENT_NOISES, MISCLASSIFIED_FLOOR,
    MISCLASSIFIED_KNOTS, NOISE_KNOTS, ODDS_KNOTS, OverDoubt, OverExtent, OverGeometry,
};

/// Noise over spacing, of both bodies together, up to which the classifier is believed in full.
const CLEAR: f64 = 0.5;
/// ... and from which on it is not asked.
const BLURRED: f64 = 1.0;

/// A contact of one shape counts over so many times the squared noise over spacing more pieces, for the noise
/// makes those about it as near; ...
const BLUR: f64 = 4.0;

/// The extent that a contact would have without noise: what the judge goes by.
pub fn sharp_extent(extent: f64, noise_over_spacing: f64) -> f64 {
    extent * sharpness(noise_over_spacing)
}

/// ... up to where the extent counts no more.
fn sharpness(noise_over_spacing: f64) -> f64 {
    1.0 / (1.0 + BLUR * noise_over_spacing.min(NOISE_KNOTS[EXTENT_NOISES]).powi(2))
}

/// How blurred the samples of two bodies are, of both together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Blur {
    /// The noise that is stated over their spacing.
    pub noise: f64,
    /// The same as far as they scatter by it: how many of them are near by chance goes by that.
    pub scatter: f64,
}

impl Blur {
    /// Where all noise shows.
    pub(crate) fn shown(noise: f64) -> Self {
        Self { noise, scatter: noise }
    }
}

/// What a [`Judge`](super::Judge) makes of the evidence of two bodies: how blurred they are keeps along a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct JudgeOfPair {
    by_geometry: OverGeometry,
    /// `None` where the noise is so large that it changes nothing.
    over_extent: Option<OverExtent>,
    sharpness: f64,
    /// As far as the classifier is believed of these bodies.
    revised: OverDoubt,
}

impl JudgeOfPair {
    /// Linear between the knots, as at the border beyond them.
    pub(super) fn new(
        over_geometry: &[OverGeometry; NOISE_KNOTS.len()],
        over_extent: &[OverExtent; EXTENT_NOISES],
        over_doubt: &OverDoubt,
        Blur { noise, scatter }: Blur,
    ) -> Self {
        let (knot, part) = between_knots(&NOISE_KNOTS, scatter);
        let by_geometry = between([&over_geometry[knot], &over_geometry[knot + 1]], part);
        let (knot, part) = between_knots(&NOISE_KNOTS, noise);
        let of_extent = |knot: usize| over_extent.get(knot).copied().unwrap_or_else(unchanged);
        let over_extent =
            (knot < EXTENT_NOISES).then(|| between([&of_extent(knot), &of_extent(knot + 1)], part));
        let believed = believed(noise);
        let mut revised = *over_doubt;
        for (row, knot) in revised.iter_mut().zip(DOUBT_KNOTS) {
            for value in row {
                *value = believed * *value + (1.0 - believed) * knot;
            }
        }
        let sharpness = sharpness(noise);
        Self { by_geometry, over_extent, sharpness, revised }
    }

    /// Whether a classifier can change log odds by geometry.
    pub(crate) fn is_open(&self, by_geometry: f64) -> bool {
        self.revise(by_geometry, 0.0) < self.revise(by_geometry, f64::INFINITY)
    }

    /// Log odds given what geometry says of the place of contact.
    pub(crate) fn log_odds_by_place(&self, deviations: f64, crossing: f64) -> f64 {
        self.geometry().at(deviations, crossing)
    }

    /// What these change by with the deviations and with the crossing.
    pub(crate) fn slopes_by_place(&self, deviations: f64, crossing: f64) -> [f64; 2] {
        self.geometry().slopes(deviations, crossing)
    }

    /// Log odds given the geometry alone: by the place of contact, and over how many pieces of surface
    /// the bodies are about as near.
    pub(crate) fn with_extent(&self, by_place: f64, extent: Option<f64>) -> f64 {
        match (extent, self.open_to_extent(by_place)) {
            (Some(extent), Some(grid)) => grid.at(by_place, -(extent * self.sharpness).ln_1p()),
            _ => by_place,
        }
    }

    /// Between what these are, whatever the extent.
    pub(crate) fn with_any_extent(&self, by_place: f64) -> [f64; 2] {
        [f64::INFINITY, 0.0].map(|extent| self.with_extent(by_place, Some(extent)))
    }

    /// What log odds by geometry change by with those by the place of contact and with the extent.
    pub(crate) fn slopes_with_extent(&self, by_place: f64, extent: Option<f64>) -> [f64; 2] {
        match (extent, self.open_to_extent(by_place)) {
            (Some(extent), Some(grid)) => {
                let sharp = extent * self.sharpness;
                let [by_place, by_column] = grid.slopes(by_place, -sharp.ln_1p());
                [by_place, -by_column * self.sharpness / (1.0 + sharp)]
            }
            _ => [1.0, 0.0],
        }
    }

    /// Whether the extent has a say at any log odds.
    pub(crate) fn counts_extent(&self) -> bool {
        self.over_extent.is_some()
    }

    /// Whether the extent has a say at such log odds by the place of contact, or at lower ones.
    pub(crate) fn may_change_with_extent(&self, by_place: f64) -> bool {
        let [.., most] = ODDS_KNOTS;
        self.counts_extent() && by_place < most
    }

    /// What the extent makes of such log odds by the place of contact, where it may change them.
    fn open_to_extent(
        &self,
        by_place: f64,
    ) -> Option<Grid<'_, { ODDS_KNOTS.len() }, { EXTENT_KNOTS.len() }>> {
        let [least, .., most] = ODDS_KNOTS;
        let values = self.over_extent.as_ref().filter(|_| least < by_place && by_place < most)?;
        Some(Grid { rows: &ODDS_KNOTS, columns: &EXTENT_KNOTS, values })
    }

    fn geometry(&self) -> Grid<'_, { DEVIATION_KNOTS.len() }, { CROSSING_KNOTS.len() }> {
        Grid { rows: &DEVIATION_KNOTS, columns: &CROSSING_KNOTS, values: &self.by_geometry }
    }

    /// Log odds given what a classifier said too; the same again where geometry leaves no doubt.
    pub(crate) fn revise(&self, by_geometry: f64, misclassified: f64) -> f64 {
        if Self::leaves_no_doubt(by_geometry) {
            return by_geometry;
        }
        self.revision().at(by_geometry, ln_above_floor(misclassified))
    }

    /// What revised log odds change by with those by geometry and with the misclassified points.
    pub(crate) fn slopes_of_revision(&self, by_geometry: f64, misclassified: f64) -> [f64; 2] {
        if Self::leaves_no_doubt(by_geometry) {
            return [1.0, 0.0];
        }
        let slopes = self.revision().slopes(by_geometry, ln_above_floor(misclassified));
        [slopes[0], slopes[1] / (misclassified + MISCLASSIFIED_FLOOR)]
    }

    fn leaves_no_doubt(by_geometry: f64) -> bool {
        let [least, .., most] = DOUBT_KNOTS;
        by_geometry <= least || by_geometry >= most
    }

    fn revision(&self) -> Grid<'_, { DOUBT_KNOTS.len() }, { MISCLASSIFIED_KNOTS.len() }> {
        Grid { rows: &DOUBT_KNOTS, columns: &MISCLASSIFIED_KNOTS, values: &self.revised }
    }
}

/// What changes no log odds, whatever the extent.
fn unchanged() -> OverExtent {
    ODDS_KNOTS.map(|odds| [odds; EXTENT_KNOTS.len()])
}

/// Two tables, weighed by how far from the first to the second.
fn between<const N: usize, const M: usize>(
    [low, high]: [&[[f64; M]; N]; 2],
    part: f64,
) -> [[f64; M]; N] {
    let mut table = *low;
    for (value, above) in table.as_flattened_mut().iter_mut().zip(high.as_flattened()) {
        *value = (1.0 - part) * *value + part * above;
    }
    table
}

/// How far the classifier is believed: where the noise is small beside the spacing.
///
/// ΣP (eq. 16) grows with the noise whether surfaces meet or not: with much noise it tells free poses from
/// collisions no better than geometry has, and takes both for collisions. What it brings is told in
/// docs/decisions/0023-where-the-classifier-pays.md.
fn believed(noise_over_spacing: f64) -> f64 {
    ((BLURRED - noise_over_spacing) / (BLURRED - CLEAR)).clamp(0.0, 1.0)
}

pub(super) fn ln_above_floor(misclassified: f64) -> f64 {
    (misclassified + MISCLASSIFIED_FLOOR).ln()
}

/// The probability at a log likelihood ratio where this share of poses collides beforehand.
pub(crate) fn probability(log_likelihood_ratio: f64, prior: f64) -> f64 {
    let log_odds = log_likelihood_ratio + (prior / (1.0 - prior)).ln();
    1.0 / (1.0 + (-log_odds).exp())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::Judge;
    use super::super::knots::MOST_DEVIATIONS;
    use super::*;

    fn judge(noise_over_spacing: f64) -> JudgeOfPair {
        Judge::default().for_blur(Blur::shown(noise_over_spacing))
    }

    #[test]
    fn belief_ends_gradually_where_noise_is_as_large_as_the_spacing() {
        assert_eq!([0.0, 0.5, 0.75, 1.0, f64::INFINITY].map(believed), [1.0, 1.0, 0.5, 0.0, 0.0]);
        let silent = Judge::default().without_classifier();
        assert_eq!(judge(0.0).revised, Judge::default().revised);
        assert_eq!(judge(1.0).revised, silent.for_blur(Blur::shown(0.0)).revised);
        let [full, half] = [0.5, 0.75].map(|noise| judge(noise).revise(0.3, 0.1) - 0.3);
        assert!((half - 0.5 * full).abs() < 1e-12 && full < -0.1, "{full} {half}");
    }

    #[test]
    fn at_the_knots_of_the_noise_a_judge_has_its_values_and_beyond_them_the_last() {
        let all = Judge::default().by_geometry;
        for (knot, of_noise) in NOISE_KNOTS.into_iter().zip(all) {
            assert_eq!(judge(knot).by_geometry, of_noise);
        }
        assert_eq!(judge(f64::INFINITY).by_geometry, all[NOISE_KNOTS.len() - 1]);
    }

    #[test]
    fn nothing_found_is_improbable_and_everything_is_not() {
        for noise in NOISE_KNOTS {
            let judge = judge(noise);
            assert!(probability(judge.log_odds_by_place(MOST_DEVIATIONS, 0.0), 0.5) < 0.005);
            // Of clouds this dense and blurred a few pieces cross by chance.
            let crossing = if noise > 5.0 { 0.97 } else { 0.99 };
            assert!(probability(judge.log_odds_by_place(0.0, 6.0), 0.5) > crossing);
            assert!(probability(judge.log_odds_by_place(-MOST_DEVIATIONS, 0.0), 0.5) > 0.99);
        }
    }

    /// The nearest of thousands of blurred pieces is near by chance: they were judged as those twice as blurred
    /// as they are far apart.
    #[test]
    fn the_denser_a_blurred_cloud_the_less_says_what_is_near() {
        let near = [2.0, 5.0, 12.0].map(|noise| judge(noise).log_odds_by_place(0.8, 0.5));
        assert!(near[0] > near[1] + 0.5 && near[1] > near[2] + 0.5, "{near:?}");
    }

    #[test]
    fn a_prior_of_one_half_changes_nothing_and_others_move_the_odds() {
        assert_eq!(probability(0.0, 0.5), 0.5);
        assert!((probability(0.0, 0.1) - 0.1).abs() < 1e-15);
        assert!((probability(9.0_f64.ln(), 0.1) - 0.5).abs() < 1e-15);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn more_evidence_never_makes_a_collision_less_probable(
            noise in 0.0..12.0_f64, z in -7.0..7.0_f64, c in 0.0..6.0_f64, m in 0.0..40.0_f64,
            n in 0.0..500.0_f64,
            step in (0.0..1.0_f64, 0.0..1.0_f64, 0.0..5.0_f64, 0.0..1.0_f64),
        ) {
            let judge = judge(noise);
            let of = |z, c, n, m| {
                let by_place = judge.log_odds_by_place(z, c);
                let by_geometry = judge.with_extent(by_place, Some(n));
                let [least, most] = judge.with_any_extent(by_place);
                assert!(least <= by_geometry && by_geometry <= most);
                judge.revise(by_geometry, m)
            };
            let more = of(z - step.0, c + step.1, n * step.3, m + step.2);
            prop_assert!(more >= of(z, c, n, m) - 1e-12);
        }

        #[test]
        fn slopes_are_what_a_small_step_changes(
            noise in 0.0..12.0_f64, z in -7.0..7.0_f64, c in 0.01..6.0_f64, m in 0.01..40.0_f64,
        ) {
            const STEP: f64 = 1e-7;
            let judge = judge(noise);
            let geometry = |z, c| judge.log_odds_by_place(z, c);
            let by_geometry = geometry(z, c);
            let [by_z, by_c] = judge.slopes_by_place(z, c);
            let [by_odds, by_m] = judge.slopes_of_revision(by_geometry, m);
            // A step over a knot has two slopes, of which either is right.
            let is_of = |slope: f64, above: f64, below: f64, here: f64| {
                let (above, below) = ((above - here) / STEP, (here - below) / STEP);
                (slope - above).abs().min((slope - below).abs()) < 1e-4 * (1.0 + slope.abs())
            };
            let revised = |odds, m| judge.revise(odds, m);
            let with_extent = |odds, n| judge.with_extent(odds, Some(n));
            let [by_place, by_n] = judge.slopes_with_extent(by_geometry, Some(m));
            let here = with_extent(by_geometry, m);
            let odds = [by_geometry + STEP, by_geometry - STEP].map(|odds| with_extent(odds, m));
            prop_assert!(is_of(by_place, odds[0], odds[1], here));
            let extents = [m + STEP, m - STEP].map(|n| with_extent(by_geometry, n));
            prop_assert!(is_of(by_n, extents[0], extents[1], here));
            prop_assert!(is_of(by_z, geometry(z + STEP, c), geometry(z - STEP, c), by_geometry));
            prop_assert!(is_of(by_c, geometry(z, c + STEP), geometry(z, c - STEP), by_geometry));
            let here = revised(by_geometry, m);
            let odds = [by_geometry + STEP, by_geometry - STEP].map(|odds| revised(odds, m));
            prop_assert!(is_of(by_odds, odds[0], odds[1], here));
            let counts = [m + STEP, m - STEP].map(|m| revised(by_geometry, m));
            prop_assert!(is_of(by_m, counts[0], counts[1], here));
        }

        #[test]
        fn a_little_more_evidence_or_noise_changes_little(
            noise in 0.0..12.0_f64, z in -7.0..7.0_f64, c in 0.0..6.0_f64, m in 0.0..40.0_f64,
        ) {
            let judge = judge(noise);
            let of = |z, c, m| judge.revise(judge.log_odds_by_place(z, c), m);
            for near in [of(z + 1e-6, c, m), of(z, c + 1e-6, m), of(z, c, m + 1e-6)] {
                prop_assert!((near - of(z, c, m)).abs() < 1e-3);
            }
            let noisier = self::judge(noise + 1e-6);
            let near = noisier.revise(noisier.log_odds_by_place(z, c), m);
            prop_assert!((near - of(z, c, m)).abs() < 1e-3);
        }
    }
}
