//! Every committed seed goes through its target: what fuzzing found once is never found again.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::{
    fs,
    panic::{AssertUnwindSafe, catch_unwind},
    path::PathBuf,
    time::{Duration, Instant},
};

/// A run that takes longer hangs; the slowest seeds take a hundredth of it.
const LONGEST: Duration = Duration::from_secs(10);

fn seeds(target: &str) -> Vec<PathBuf> {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    let mut paths: Vec<PathBuf> =
        fs::read_dir(root.join(target)).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

#[test]
fn every_seed_passes() {
    let mut failed = Vec::new();
    for &(name, target) in cloudtouch_fuzzing::TARGETS {
        let paths = seeds(name);
        assert!(!paths.is_empty(), "no seeds for {name}");
        for path in paths {
            let bytes = fs::read(&path).unwrap();
            let start = Instant::now();
            let passed = catch_unwind(AssertUnwindSafe(|| target(&bytes))).is_ok();
            if !passed || start.elapsed() > LONGEST {
                failed.push(format!("{} ({:?})", path.display(), start.elapsed()));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn every_folder_of_seeds_has_a_target() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    for entry in fs::read_dir(root).unwrap() {
        let name = entry.unwrap().file_name();
        // A build without recordings has no target for them.
        if name == "read_mcap" && cfg!(not(feature = "mcap")) {
            continue;
        }
        assert!(
            cloudtouch_fuzzing::TARGETS.iter().any(|(target, _)| name == *target),
            "{name:?} has no target"
        );
    }
}
