//! A run that is ended from outside: nothing half written is left behind.
#![allow(clippy::unwrap_used, reason = "tests")]
#![cfg(unix)]

use std::os::unix::process::ExitStatusExt as _;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::{Inputs, case_at, case_file};

/// A signal by its name, and whether an older file had the name of the output.
const ENDS: [(&str, bool); 2] = [("INT", false), ("TERM", true)];

#[test]
fn a_batch_that_was_interrupted_left_a_hidden_file() {
    let inputs = Inputs::new();
    // Enough of them for the signal to come in between.
    let cases: Vec<String> = (0..20_000).map(|i| case_at(&format!("c{i}"), 0.09)).collect();
    inputs.write("cases.json", &case_file(&cases));
    for (signal, is_there) in ENDS {
        let before = inputs.names();
        if is_there {
            inputs.write("old.jsonl", "old");
        }
        let output = if is_there { "old.jsonl" } else { "new.jsonl" };
        let mut run = Command::new(assert_cmd::cargo::cargo_bin("cloudtouch"))
            .current_dir(inputs.path(""))
            .args(["batch", "cases.json", "--force", "--jsonl", output])
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let is_partial = |name: &String| name.ends_with(".partial");
        let begun = Instant::now();
        while !inputs.names().iter().any(is_partial) {
            assert!(begun.elapsed() < Duration::from_secs(60), "it wrote nothing");
            std::thread::sleep(Duration::from_millis(5));
        }
        let killed = Command::new("kill").args(["-s", signal, &run.id().to_string()]).status();
        assert!(killed.unwrap().success());
        let status = run.wait().unwrap();
        assert!(!status.success(), "{status}, {:?}", status.signal());
        if is_there {
            assert_eq!(std::fs::read_to_string(inputs.path("old.jsonl")).unwrap(), "old");
            std::fs::remove_file(inputs.path("old.jsonl")).unwrap();
        }
        assert_eq!(inputs.names(), before, "SIG{signal}");
    }
}
