//! Measures as files: one row for each group of poses, method and measure.

use std::{fmt::Write as _, path::Path};

use anyhow::Result;
use serde::Serialize;

use super::{Estimate, Measured};
use crate::{common::files::write_whole, sweep::record::quoted};

/// One measure of one method on one group of poses, or the difference of two methods.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Row {
    /// Which poses.
    pub(crate) group: String,
    pub(crate) method: String,
    /// The method whose measure was taken off, for a difference on the same poses.
    pub(crate) minus: Option<String>,
    pub(crate) measure: String,
    /// Answers of each method.
    pub(crate) answers: usize,
    /// How many of them are to poses that collide.
    pub(crate) collisions: usize,
    /// Null in JSON and empty in CSV when undefined.
    pub(crate) value: f64,
    /// 95 % interval.
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Measured {
    /// Rows of all measures and of the differences of every other method from `baseline`.
    pub(crate) fn rows(
        &self,
        group: &str,
        (answers, collisions): (usize, usize),
        baseline: &str,
    ) -> Vec<Row> {
        let row = |method: &str, minus: Option<&str>, measure: String, estimate: Estimate| Row {
            group: group.to_owned(),
            method: method.to_owned(),
            minus: minus.map(str::to_owned),
            measure,
            answers,
            collisions,
            value: estimate.value,
            low: estimate.low,
            high: estimate.high,
        };
        let mut rows = Vec::new();
        for method in self.methods() {
            for &measure in self.measures() {
                let estimate = self.estimate(method, measure);
                rows.extend(estimate.map(|e| row(method, None, measure.name(), e)));
                if method != baseline {
                    let difference = self.difference(method, baseline, measure);
                    rows.extend(difference.map(|e| row(method, Some(baseline), measure.name(), e)));
                }
            }
        }
        rows
    }
}

/// Writes the rows as CSV.
///
/// # Errors
///
/// When the file cannot be written.
pub(crate) fn write_csv(path: &Path, rows: &[Row]) -> Result<()> {
    write_whole(path, csv(rows))
}

/// Writes the rows as a JSON list.
///
/// # Errors
///
/// When the file cannot be written.
pub(crate) fn write_json(path: &Path, rows: &[Row]) -> Result<()> {
    write_whole(path, serde_json::to_string_pretty(rows)? + "\n")
}

fn csv(rows: &[Row]) -> String {
    let mut text = String::from("group,method,minus,measure,answers,collisions,value,low,high\n");
    for row in rows {
        let [value, low, high] = [row.value, row.low, row.high]
            .map(|v| if v.is_nan() { String::new() } else { v.to_string() });
        let [group, method, minus, measure] =
            [&row.group, &row.method, row.minus.as_ref().unwrap_or(&String::new()), &row.measure]
                .map(|text| quoted(text));
        let (answers, collisions) = (row.answers, row.collisions);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{group},{method},{minus},{measure},{answers},{collisions},{value},{low},{high}"
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{
        super::{Bootstrap, Clusters, Measure, measure, sample::tests::sample},
        *,
    };

    #[test]
    fn rows_have_values_and_differences_and_holes_where_undefined() {
        let methods = [("a, new", 0.9), ("b", 0.6)]
            .map(|(name, p)| (name.to_owned(), sample(&[(p, true), (0.2, false)])));
        let measures = [Measure::Brier, Measure::Coverage];
        let clusters = Clusters::separate(2);
        let measured = measure(&methods, &measures, &clusters, Bootstrap::new(1));
        let rows = measured.rows("all", (2, 1), "b");
        assert_eq!(rows.len(), 6);
        let text = csv(&rows);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[1].starts_with("all,\"a, new\",,Brier,2,1,0.02"), "{text}");
        assert!(lines[2].starts_with("all,\"a, new\",b,Brier,2,1,-0.07"), "{text}");
        assert_eq!(lines[3], "all,\"a, new\",,coverage of bounds,2,1,,,");
        let json = serde_json::to_value(&rows).unwrap();
        assert!(json[2]["value"].is_null() && json[0]["minus"].is_null());
        assert_eq!(json[1]["minus"], "b");
    }
}
