//! A report page where scripts are off: all that was answered can be read. Skipped, with the reason, where no Chromium
//! is found.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use serde_json::json;

use crate::support::browser::{Tab, chromium};
use crate::support::{Inputs, case_at, case_file};

/// Only the first pose was there, and beside it that answers need no script.
#[test]
fn all_poses_but_one_were_hidden_where_scripts_are_off() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    let heights = [("apart", 0.5), ("near", 0.12), ("touching", 0.09)];
    inputs.write("cases.json", &case_file(&heights.map(|(name, height)| case_at(name, height))));
    inputs.run(&["batch", "cases.json", "--html=o.html"]).quiet(0);
    let mut tab = Tab::open(&browser, &inputs.path("o.html"), [1000, 700], false);
    let shown =
        "[...document.querySelectorAll('section.answer')].filter((e) => e.offsetHeight > 0).length";
    assert_eq!(tab.value(shown), 1, "the slider chooses one");
    tab.ask("Emulation.setScriptExecutionDisabled", json!({"value": true}));
    tab.value("document.body.id = 'before'");
    tab.ask("Page.reload", json!({}));
    while tab.value("document.body?.id === 'before' || document.readyState !== 'complete'") == true
    {
    }
    assert_eq!(tab.value("document.querySelectorAll('canvas').length"), 0, "a script ran");
    assert_eq!(tab.value(shown), 3);
    // The colours of the picture that is not there.
    assert_eq!(tab.value("document.getElementById('legend').offsetHeight"), 0);
}
