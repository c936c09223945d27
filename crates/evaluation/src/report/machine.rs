//! Where and when a run took place.

use std::fs;
use std::path::Path;
use std::process::Command;

/// The lines of a page that say when, from what and where its numbers were made.
pub(super) fn provenance(root: &Path, seed: u64) -> String {
    let date = jiff::Timestamp::now().strftime("%F");
    let (commit, processor) = (commit(root), processor());
    format!("- date: {date}\n- commit: {commit}\n- machine: {processor}\n- seed: {seed}\n")
}

/// Processor and number of cores.
fn processor() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info
        .lines()
        .filter_map(|line| line.split_once(':'))
        .find(|(key, _)| key.trim() == "model name")
        .map_or("unknown processor", |(_, model)| model.trim());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{model}, {cores} cores")
}

/// The commit of the sources, and whether they differ from it.
fn commit(root: &Path) -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).current_dir(root).output().ok()?;
        let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
        output.status.success().then_some(text)
    };
    let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]) else { return "unknown".into() };
    match git(&["status", "--porcelain", "--", "crates"]) {
        Some(changes) if changes.is_empty() => commit,
        _ => format!("{commit} with changes in crates/"),
    }
}
