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
    met: bool,
}

impl Target {
    /// A value that must not be larger; NaN is not met.
    pub(super) fn at_most(
        what: impl Into<String>,
        value: f64,
        limit: f64,
        show: impl Fn(f64) -> String,
    ) -> Self {
        Self { what: what.into(), measured: show(value), met: value <= limit }
    }

    /// A value that must not be smaller; NaN is not met.
    pub(super) fn at_least(
        what: impl Into<String>,
        value: f64,
        limit: f64,
        show: impl Fn(f64) -> String,
    ) -> Self {
        Self { met: value >= limit, ..Self::at_most(what, value, limit, show) }
    }
}

/// All targets in a table.
pub(super) fn table(targets: &[Target]) -> Table {
    let mut table = Table::new(["target", "measured", "met"]);
    for Target { what, measured, met } in targets {
        table.row([what.as_str(), measured, if *met { "yes" } else { "**no**" }]);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_judged_from_the_right_side_and_nothing_is_met_by_no_number() {
        let show = |v: f64| format!("{v}");
        for (value, most, least) in
            [(1.0, true, false), (2.0, true, true), (2.1, false, true), (f64::NAN, false, false)]
        {
            assert_eq!(Target::at_most("t", value, 2.0, show).met, most, "{value}");
            assert_eq!(Target::at_least("t", value, 2.0, show).met, least, "{value}");
        }
    }
}
