//! Commands that must succeed, cargo's first of all.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};

/// The features by which recordings of robots are read. All steps have them: with others most crates of
/// others are built once more.
pub(crate) const RECORDINGS: &str =
    "--features cloudtouch-io/mcap,cloudtouch-cli/mcap,cloudtouch-fuzzing/mcap";
/// An example that is named beside what is wanted, for then crates get the features that tests build them
/// with, and are those that the tests use.
pub(crate) const AS_TESTED: &str = "--example instructions";

/// The cargo that runs this task, in the project's folder.
pub(crate) fn cargo(root: &Path, arguments: &str) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments.split_whitespace()).current_dir(root);
    command
}

/// An example that the tests of the workspace have built. By `cargo run` its crates would be built anew,
/// for alone they have other features.
pub(crate) fn example(name: &str) -> Result<Command> {
    let program = std::env::current_exe()?;
    let target = program.ancestors().nth(2).context("the target folder")?;
    Ok(Command::new(target.join("debug/examples").join(name)))
}

/// Runs it; fails where it does.
pub(crate) fn succeed(command: &mut Command) -> Result<()> {
    let status = command.status().with_context(|| format!("start {command:?}"))?;
    ensure!(status.success(), "{command:?} ended with {status}");
    Ok(())
}
