//! What a run collects for its page: sections, goals, and answers that are not sound.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::{page::Section, table::Table};

/// All randomness of the run comes from this.
pub(super) const SEED: u64 = 2011;

/// All that a run found.
#[derive(Default)]
pub(super) struct Sheet {
    pub(super) sections: Vec<Section>,
    /// What was to be reached, what was measured, and whether it was reached.
    goals: Vec<(String, String, bool)>,
    /// Panics, numbers that are not, answers against the truth.
    pub(super) faults: Vec<String>,
}

impl Sheet {
    pub(super) fn goal(&mut self, what: impl Into<String>, measured: String, met: bool) {
        self.goals.push((what.into(), measured, met));
    }

    pub(super) fn fault(&mut self, text: String) {
        self.faults.push(text);
    }

    /// Runs something that may panic, which is a fault with this name.
    pub(super) fn guard<T>(&mut self, name: &str, action: impl FnOnce() -> T) -> Option<T> {
        let outcome = catch_unwind(AssertUnwindSafe(action));
        let message = |payload: &Box<dyn std::any::Any + Send>| {
            let text = payload.downcast_ref::<&str>().map(|text| (*text).to_owned());
            let text = text.or_else(|| payload.downcast_ref::<String>().cloned());
            format!("{name}: panics: {}", text.unwrap_or("no message".into()))
        };
        outcome.inspect_err(|payload| self.fault(message(payload))).ok()
    }

    /// The last goal, when all else is done: no faults.
    pub(super) fn close(&mut self) {
        let what = "no panic, no number that is not one, no wrong verdict, bounded steps";
        self.goal(what, format!("{} faults", self.faults.len()), self.faults.is_empty());
    }

    /// The goals that were missed.
    pub(super) fn missed(&self) -> Vec<&str> {
        self.goals.iter().filter(|goal| !goal.2).map(|goal| goal.0.as_str()).collect()
    }

    pub(super) fn goals(&self) -> Table {
        let mut table = Table::new(["goal", "measured", "met"]);
        for (what, measured, met) in &self.goals {
            table.row([what.as_str(), measured.as_str(), if *met { "yes" } else { "**no**" }]);
        }
        table
    }
}

/// A number that may be very small or none.
pub(super) fn small(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.0e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_fault_and_a_missed_goal() {
        let mut sheet = Sheet::default();
        sheet.goal("within reach", "all".into(), true);
        assert_eq!(sheet.guard("good", || 3), Some(3));
        let text = String::from("far too hard");
        assert_eq!(sheet.guard("bad", || assert!(text.is_empty(), "{text}")), None);
        assert_eq!(sheet.faults, ["bad: panics: far too hard"]);
        assert!(sheet.missed().is_empty());
        sheet.goal("out of reach", "none".into(), false);
        sheet.close();
        assert_eq!(sheet.missed().len(), 2);
    }
}
