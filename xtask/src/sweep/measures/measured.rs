//! All measures of all methods on the same poses, with intervals and paired differences.

use super::{
    Bootstrap, Clusters, Estimate, Sample, bootstrap::Replicates, bounds, calibration, proper,
    rank, replicate, threshold,
};
use crate::common::table::Table;

/// Something that tells how good answers are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Measure {
    /// Chance that a collision has a higher score than a free pose.
    Auc,
    /// Mean squared difference of probability and truth.
    Brier,
    /// Mean −ln of the probability given to what is true, probabilities clipped at 1e-6.
    LogLoss,
    /// Mean distance of probability and observed rate over 15 equal bins.
    CalibrationError,
    /// Rank correlation of the score with minus the signed distance.
    Spearman,
    /// Share of free poses stopped by the highest threshold that misses at most this share of
    /// the collisions.
    FalseStops(f64),
    /// Share of right verdicts at the method's best threshold.
    RightAtBest,
    /// Share of probabilities in (0.05, 0.95).
    Undecided,
    /// Share of poses whose bounds contain the reference probability.
    Coverage,
}

impl Measure {
    /// Every measure, false stops at misses of 1 % and 5 %.
    pub(crate) const ALL: [Self; 10] = [
        Self::Auc,
        Self::Brier,
        Self::LogLoss,
        Self::CalibrationError,
        Self::Spearman,
        Self::FalseStops(0.01),
        Self::FalseStops(0.05),
        Self::RightAtBest,
        Self::Undecided,
        Self::Coverage,
    ];

    /// Its name in tables and files.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Auc => "AUC".into(),
            Self::Brier => "Brier".into(),
            Self::LogLoss => "log loss".into(),
            Self::CalibrationError => "ECE".into(),
            Self::Spearman => "Spearman".into(),
            Self::FalseStops(rate) => format!("false stops at {} % misses", 100.0 * rate),
            Self::RightAtBest => "right at best threshold".into(),
            Self::Undecided => "P in (.05, .95)".into(),
            Self::Coverage => "coverage of bounds".into(),
        }
    }

    /// Its value, each answer counting as often as its weight says; NaN when undefined.
    pub(crate) fn of(self, sample: &Sample, weights: &[f64]) -> f64 {
        match self {
            Self::Auc => rank::auc(sample, weights),
            Self::Brier => proper::brier(sample, weights),
            Self::LogLoss => proper::log_loss(sample, weights),
            Self::CalibrationError => calibration::calibration_error(sample, weights),
            Self::Spearman => rank::spearman(sample, weights),
            Self::FalseStops(rate) => threshold::false_stops(sample, weights, rate),
            Self::RightAtBest => threshold::best_threshold(sample, weights).1,
            Self::Undecided => proper::undecided(sample, weights),
            Self::Coverage => bounds::coverage(sample, weights),
        }
    }
}

/// Measures of several methods on the same poses and the same resamples of them.
#[derive(Debug, Clone)]
pub(crate) struct Measured {
    methods: Vec<String>,
    measures: Vec<Measure>,
    replicates: Replicates,
}

/// Computes these measures for each method; all samples are of the same poses.
pub(crate) fn measure(
    methods: &[(String, Sample)],
    measures: &[Measure],
    clusters: &Clusters,
    bootstrap: Bootstrap,
) -> Measured {
    let replicates = replicate(clusters, bootstrap, |weights| {
        let of_method = |(_, sample): &(String, Sample)| {
            measures.iter().map(|measure| measure.of(sample, weights)).collect::<Vec<f64>>()
        };
        methods.iter().flat_map(of_method).collect()
    });
    Measured {
        methods: methods.iter().map(|(name, _)| name.clone()).collect(),
        measures: measures.to_vec(),
        replicates,
    }
}

impl Measured {
    /// The methods, as they were given.
    pub(crate) fn methods(&self) -> &[String] {
        &self.methods
    }

    /// The measures, as they were given.
    pub(crate) fn measures(&self) -> &[Measure] {
        &self.measures
    }

    /// One measure of one method; `None` when either was not asked for.
    pub(crate) fn estimate(&self, method: &str, measure: Measure) -> Option<Estimate> {
        Some(self.replicates.estimate(self.index(method, measure)?))
    }

    /// One measure of the first method minus that of the second, on the same poses.
    pub(crate) fn difference(
        &self,
        first: &str,
        second: &str,
        measure: Measure,
    ) -> Option<Estimate> {
        let [first, second] = [first, second].map(|method| self.index(method, measure));
        Some(self.replicates.difference(first?, second?))
    }

    /// A row for each method, a column for each of these measures.
    pub(crate) fn table(&self, shown: &[Measure]) -> Table {
        table_of("method", &self.methods, shown, |method, measure| {
            self.estimate(method, measure).map_or(String::new(), |e| e.to_string())
        })
    }

    /// How much every other method differs from this one; bold where the interval excludes zero.
    pub(crate) fn differences_table(&self, from: &str, shown: &[Measure]) -> Table {
        let others: Vec<String> = self.methods.iter().filter(|m| *m != from).cloned().collect();
        table_of(&format!("minus {from}"), &others, shown, |method, measure| {
            match self.difference(method, from, measure) {
                Some(e) if e.excludes_zero() => format!("**{e:+}**"),
                Some(e) => format!("{e:+}"),
                None => String::new(),
            }
        })
    }

    fn index(&self, method: &str, measure: Measure) -> Option<usize> {
        let method = self.methods.iter().position(|m| m == method)?;
        let measure = self.measures.iter().position(|m| *m == measure)?;
        Some(method * self.measures.len() + measure)
    }
}

fn table_of(
    corner: &str,
    rows: &[String],
    shown: &[Measure],
    cell: impl Fn(&str, Measure) -> String,
) -> Table {
    let names: Vec<String> = shown.iter().map(|m| m.name()).collect();
    let header: Vec<&str> =
        std::iter::once(corner).chain(names.iter().map(String::as_str)).collect();
    let mut table = Table::new(&header);
    for method in rows {
        let cells = shown.iter().map(|&measure| cell(method, measure));
        table.row(std::iter::once(method.clone()).chain(cells));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::{super::sample::tests::sample, *};

    fn measured() -> Measured {
        let good: Vec<(f64, bool)> =
            (0..40).map(|i| (f64::from(i) / 40.0, i >= 20 && i != 25 || i == 12)).collect();
        let bad: Vec<(f64, bool)> = good.iter().map(|&(p, truth)| (1.0 - p, truth)).collect();
        let methods = [("good", good), ("bad", bad)].map(|(name, s)| (name.to_owned(), sample(&s)));
        measure(&methods, &Measure::ALL, &Clusters::separate(40), Bootstrap::new(3))
    }

    #[test]
    fn every_measure_has_its_interval_about_it() {
        let measured = measured();
        for measure in Measure::ALL {
            let of_good = measured.estimate("good", measure).unwrap();
            if measure == Measure::Coverage {
                assert!(of_good.value.is_nan());
                continue;
            }
            assert!(of_good.low < of_good.high, "{measure:?} {of_good:?}");
            assert!(of_good.value <= of_good.high, "{measure:?} {of_good:?}");
            // The resamples of a calibration error may all lie above it.
            let is_above = of_good.low <= of_good.value;
            assert!(is_above || measure == Measure::CalibrationError, "{measure:?} {of_good:?}");
        }
        assert!(measured.estimate("ugly", Measure::Auc).is_none());
    }

    #[test]
    fn the_better_method_is_better() {
        let measured = measured();
        let auc = measured.difference("good", "bad", Measure::Auc).unwrap();
        assert!(auc.low > 0.5 && auc.excludes_zero(), "{auc:?}");
        let brier = measured.difference("good", "bad", Measure::Brier).unwrap();
        assert!(brier.high < -0.2, "{brier:?}");
    }

    #[test]
    fn tables_have_a_row_for_each_method() {
        let measured = measured();
        let table = measured.table(&Measure::ALL).to_string();
        assert_eq!(table.lines().count(), 4);
        assert!(table.contains("false stops at 1 % misses"), "{table}");
        let auc = measured.estimate("good", Measure::Auc).unwrap();
        assert!(table.contains(&format!("| good   | {auc} ")), "{table}");
        let differences = measured.differences_table("good", &Measure::ALL).to_string();
        assert_eq!(differences.lines().count(), 3);
        assert!(differences.contains("| minus good |") && differences.contains("| **-."));
    }
}
