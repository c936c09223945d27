//! What is to be reached, and whether it was.

use anyhow::Result;

use crate::{page::Section, table::Table};

/// What a part of a run finds.
pub(super) type Findings = Result<(Section, Vec<Target>)>;

/// A target with what was measured of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Target {
    what: String,
    measured: String,
    /// None where nothing was measured.
    pub(super) met: Option<bool>,
}

impl Target {
    /// A value that must not be larger; NaN counts as not measured.
    pub(super) fn at_most(
        what: impl Into<String>,
        value: f64,
        limit: f64,
        show: impl Fn(f64) -> String,
    ) -> Self {
        Self::judged(what.into(), value, value <= limit, show)
    }

    /// A value that must not be smaller; NaN counts as not measured.
    pub(super) fn at_least(
        what: impl Into<String>,
        value: f64,
        limit: f64,
        show: impl Fn(f64) -> String,
    ) -> Self {
        Self::judged(what.into(), value, value >= limit, show)
    }

    /// Something that must hold.
    pub(super) fn holds(what: impl Into<String>, measured: String, met: bool) -> Self {
        Self { what: what.into(), measured, met: Some(met) }
    }

    /// A target of which nothing was measured, and why.
    pub(super) fn skipped(what: impl Into<String>, reason: &str) -> Self {
        Self { what: what.into(), measured: reason.to_owned(), met: None }
    }

    fn judged(what: String, value: f64, met: bool, show: impl Fn(f64) -> String) -> Self {
        if value.is_nan() {
            return Self::skipped(what, "not measured");
        }
        Self::holds(what, show(value), met)
    }
}

/// All targets in a table.
pub(super) fn table<'a>(targets: impl IntoIterator<Item = &'a Target>) -> Table {
    let mut table = Table::new(["target", "measured", "met"]);
    for Target { what, measured, met } in targets {
        let met = met.map_or("-", |met| if met { "yes" } else { "**no**" });
        table.row([what, measured, met]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_judged_from_the_right_side_and_nothing_is_met_unmeasured() {
        let show = |v: f64| format!("{v}");
        for (value, most, least) in [
            (1.0, Some(true), Some(false)),
            (2.0, Some(true), Some(true)),
            (2.1, Some(false), Some(true)),
            (f64::INFINITY, Some(false), Some(true)),
            (f64::NAN, None, None),
        ] {
            assert_eq!(Target::at_most("t", value, 2.0, show).met, most, "{value}");
            assert_eq!(Target::at_least("t", value, 2.0, show).met, least, "{value}");
        }
    }
}
