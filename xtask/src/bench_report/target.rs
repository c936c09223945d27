//! What is to be reached, and whether it was.

use crate::common::table::Table;

/// A target with what was measured of it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Target {
    what: String,
    measured: String,
    /// None where nothing was measured.
    met: Option<bool>,
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
    let mut table = Table::new(&["target", "measured", "met"]);
    for target in targets {
        let met = match target.met {
            Some(true) => "yes",
            Some(false) => "**no**",
            None => "-",
        };
        table.row([target.what.clone(), target.measured.clone(), met.into()]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn met(target: &Target) -> String {
        let table = table([target]).to_string();
        let last = table.lines().last().unwrap();
        last.trim_end_matches(['|', ' ']).rsplit("| ").next().unwrap().to_owned()
    }

    #[test]
    fn limits_are_judged_from_the_right_side() {
        let show = |v: f64| format!("{v}");
        for (value, most, least) in
            [(1.0, "yes", "**no**"), (2.0, "yes", "yes"), (2.1, "**no**", "yes")]
        {
            assert_eq!(met(&Target::at_most("t", value, 2.0, show)), most, "{value}");
            assert_eq!(met(&Target::at_least("t", value, 2.0, show)), least, "{value}");
        }
        assert_eq!(met(&Target::at_most("t", f64::INFINITY, 2.0, show)), "**no**");
        assert_eq!(met(&Target::holds("t", "different".into(), false)), "**no**");
    }

    #[test]
    fn what_was_not_measured_is_neither_met_nor_missed() {
        let show = |v: f64| format!("{v}");
        assert_eq!(met(&Target::at_most("t", f64::NAN, 2.0, show)), "-");
        assert_eq!(met(&Target::at_least("t", f64::NAN, 2.0, show)), "-");
        let table = table([&Target::skipped("memory", "no /proc here")]).to_string();
        assert!(table.contains("| memory | no /proc here | -"), "{table}");
    }
}
