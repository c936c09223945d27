//! What `--margin` adds to an answer.

use cloudtouch::Within;
use serde_json::{Value, json};

/// The share of the interval that is told of a clearance: what it is below and above is as likely.
pub(crate) const SHARE: f64 = 0.9;

/// How likely the bodies are within a margin, and between what distances they lie.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearness {
    pub within: Within,
    /// Ends of the interval, m.
    pub interval: [f64; 2],
}

impl Nearness {
    /// Puts both into an answer in JSON.
    pub(crate) fn add_to(&self, answer: &mut Value) {
        let [q05, q95] = self.interval;
        let at_least = answer["clearance_at_least_m"].clone();
        if answer["clearance_m"].is_null() {
            answer["clearance_m"] = json!({ "mean": null, "std": null, "is_bound": false });
        }
        let clearance = &mut answer["clearance_m"];
        clearance["at_least"] = at_least;
        clearance["q05"] = json!(q05);
        clearance["q95"] = json!(q95);
        answer["margin"] = json!(self.within);
    }
}
