//! What a run collects for its page: sections, goals, and answers that are not sound.

use std::{
    any::Any,
    panic::{AssertUnwindSafe, catch_unwind},
};

use crate::{page::Section, table::Table};

/// All randomness of the run comes from this.
pub(super) const SEED: u64 = 2011;

/// Something to be reached, and whether it was.
struct Goal {
    what: String,
    measured: String,
    met: bool,
}

/// All that a run found.
#[derive(Default)]
pub(super) struct Sheet {
    pub(super) sections: Vec<Section>,
    goals: Vec<Goal>,
    /// Panics, numbers that are not, answers against the truth.
    pub(super) faults: Vec<String>,
}

impl Sheet {
    pub(super) fn goal(&mut self, what: impl Into<String>, measured: String, met: bool) {
        self.goals.push(Goal { what: what.into(), measured, met });
    }

    pub(super) fn fault(&mut self, text: String) {
        self.faults.push(text);
    }

    /// Runs something that may panic, which is a fault with this name.
    pub(super) fn guard<T>(&mut self, name: &str, action: impl FnOnce() -> T) -> Option<T> {
        match catch_unwind(AssertUnwindSafe(action)) {
            Ok(value) => Some(value),
            Err(payload) => {
                self.fault(format!("{name}: panics: {}", message(payload.as_ref())));
                None
            }
        }
    }

    /// The goals that were missed; not to have any fault is one of them.
    pub(super) fn missed(&self) -> Vec<String> {
        self.all_goals().filter(|goal| !goal.met).map(|goal| goal.what).collect()
    }

    pub(super) fn goals(&self) -> Table {
        let mut table = Table::new(["goal", "measured", "met"]);
        for goal in self.all_goals() {
            table.row([goal.what, goal.measured, if goal.met { "yes" } else { "**no**" }.into()]);
        }
        table
    }

    fn all_goals(&self) -> impl Iterator<Item = Goal> {
        let sound = Goal {
            what: "no panic, no number that is not one, no wrong verdict, bounded steps".into(),
            measured: format!("{} faults", self.faults.len()),
            met: self.faults.is_empty(),
        };
        let copy =
            |g: &Goal| Goal { what: g.what.clone(), measured: g.measured.clone(), met: g.met };
        self.goals.iter().map(copy).chain([sound])
    }
}

fn message(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message")
}

/// A number that may be very small or none.
pub(super) fn small(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.0e}") }
}

/// Milliseconds with the digits that mean something.
pub(super) fn milliseconds(seconds: f64) -> String {
    let ms = 1e3 * seconds;
    if ms < 10.0 { format!("{ms:.2}") } else { format!("{ms:.0}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_fault_and_a_missed_goal() {
        let mut sheet = Sheet::default();
        sheet.goal("within reach", "all".into(), true);
        assert_eq!((sheet.guard("good", || 3), sheet.missed().len()), (Some(3), 0));
        let text = String::from("far too hard");
        assert_eq!(sheet.guard("bad", || assert!(text.is_empty(), "{text}")), None);
        assert_eq!(sheet.faults, ["bad: panics: far too hard"]);
        sheet.goal("out of reach", "none".into(), false);
        assert_eq!(sheet.missed().len(), 2);
    }
}
