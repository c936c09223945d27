//! What a run collects for its document: sections, goals, and answers that are not sound.

use std::{
    any::Any,
    panic::{AssertUnwindSafe, catch_unwind},
};

/// A section of the document.
pub(super) struct Section {
    pub(super) title: &'static str,
    pub(super) text: String,
}

/// Something to be reached, and whether it was.
pub(super) struct Goal {
    pub(super) what: String,
    pub(super) measured: String,
    pub(super) met: bool,
}

/// All that a run found.
#[derive(Default)]
pub(super) struct Sheet {
    pub(super) sections: Vec<Section>,
    pub(super) goals: Vec<Goal>,
    /// Panics, numbers that are not, answers against the truth.
    pub(super) faults: Vec<String>,
}

impl Sheet {
    pub(super) fn section(&mut self, title: &'static str, text: String) {
        self.sections.push(Section { title, text });
    }

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
    fn a_panic_becomes_a_fault() {
        let mut sheet = Sheet::default();
        assert_eq!(sheet.guard("good", || 3), Some(3));
        let text = String::from("far too hard");
        assert_eq!(sheet.guard("bad", || assert!(text.is_empty(), "{text}")), None);
        assert_eq!(sheet.faults, ["bad: panics: far too hard"]);
    }
}
