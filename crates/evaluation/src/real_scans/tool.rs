//! Runs the `cloudtouch` command and reads its JSON lines: here the tool itself is tested.

use std::{fs, path::Path, process::Command};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

/// Builds the tool as this program was built and answers a case file on one thread; one JSON
/// object for each case.
pub(super) fn batch(root: &Path, cases: &Path, options: &[&str]) -> Result<Vec<Value>> {
    let mut build = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
    build.current_dir(root).args(["build", "--package", "cloudtouch-cli"]);
    if !cfg!(debug_assertions) {
        build.arg("--release");
    }
    ensure!(build.status().context("start cargo")?.success(), "the tool cannot be built");
    let tool = std::env::current_exe()?
        .with_file_name(format!("cloudtouch{}", std::env::consts::EXE_SUFFIX));
    let folder = root.join("target/lab");
    fs::create_dir_all(&folder)?;
    let lines = folder.join("real-scans.jsonl");
    // Lines of an earlier run must not pass for this one's.
    let _ = fs::remove_file(&lines);
    let mut batch = Command::new(&tool);
    batch.env("RAYON_NUM_THREADS", "1").arg("batch").arg(cases).args(options);
    // The status also says that some case has no answer; the lines tell which.
    let output = batch.arg("--jsonl").arg(&lines).output();
    let output = output.with_context(|| format!("start {}", tool.display()))?;
    let text = fs::read_to_string(&lines)
        .with_context(|| format!("cloudtouch: {}", String::from_utf8_lossy(&output.stderr)))?;
    let parsed = text.lines().map(serde_json::from_str).collect::<Result<_, _>>();
    parsed.with_context(|| format!("read {}", lines.display()))
}
