//! `cargo xtask ci`: every check, in order, each with its time; stops at the first failure.

use std::{
    io::{BufRead, BufReader},
    path::Path,
    process::{Command, ExitStatus, Stdio},
    time::Instant,
};

use anyhow::{Context, Result, bail};

use cloudtouch_evaluation::sweep;

use crate::{fixtures, tidy};

/// Not published, so not packaged.
const UNPUBLISHED: [&str; 5] = [
    "cloudtouch-testkit",
    "cloudtouch-evaluation",
    "cloudtouch-fuzzing",
    "cloudtouch-benches",
    "xtask",
];

/// Runs every step. Tests come last, and the last line sums them up.
pub(crate) fn run(root: &Path) -> Result<()> {
    step("fmt", "cargo fmt --all -- --check", || cargo(root, "fmt --all -- --check"))?;
    step("tidy", "cargo xtask tidy", || tidy::run(root))?;
    step("fixtures", "cargo xtask fixtures --check", || fixtures::check(root))?;
    // The lock file holds: what is checked is what was committed, and no network is needed.
    let clippy = "clippy --locked --workspace --all-targets -- -D warnings";
    step("clippy", &format!("cargo {clippy}"), || cargo(root, clippy))?;
    // The tool is left out: its binary and the library it wraps would share one page.
    let doc = "doc --locked --workspace --exclude cloudtouch-cli --no-deps";
    step("doc", &format!("RUSTDOCFLAGS='-D warnings' cargo {doc}"), || {
        succeed(command(root, doc).env("RUSTDOCFLAGS", "-D warnings"))
    })?;
    let benches = "check --locked --package cloudtouch-benches --benches";
    step("benches", &format!("cargo {benches}"), || cargo(root, benches))?;
    let exclude: String = UNPUBLISHED.iter().map(|name| format!(" --exclude {name}")).collect();
    let package = format!("package --locked --workspace{exclude} --allow-dirty --no-verify");
    step("package", &format!("cargo {package}"), || cargo(root, &package))?;
    step("sweep", "cargo xtask sweep --short", sweep::check)?;
    let test = "test --locked --workspace --no-fail-fast";
    let mut tally = Tally::default();
    let result = step("test", &format!("PROPTEST_RNG_SEED={PROPERTY_SEED} cargo {test}"), || {
        cargo_test(root, test, &mut tally)
    });
    println!("tests: {} passed, {} failed", tally.passed, tally.failed);
    result
}

/// Runs one step and says how long it took, or how to run it again.
fn step(name: &str, rerun: &str, action: impl FnOnce() -> Result<()>) -> Result<()> {
    println!("==> {name}: {rerun}");
    let start = Instant::now();
    action().with_context(|| format!("step {name} failed; rerun it with: {rerun}"))?;
    println!("==> {name}: ok in {:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// The cargo that runs this task, in the project's folder.
fn command(root: &Path, arguments: &str) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments.split_whitespace()).current_dir(root);
    command
}

fn cargo(root: &Path, arguments: &str) -> Result<()> {
    succeed(&mut command(root, arguments))
}

fn succeed(command: &mut Command) -> Result<()> {
    judge(command.status().context("start cargo")?)
}

fn judge(status: ExitStatus) -> Result<()> {
    if !status.success() {
        bail!("cargo ended with {status}");
    }
    Ok(())
}

/// Passed and failed tests over all test binaries.
#[derive(Debug, Default, PartialEq)]
struct Tally {
    passed: u64,
    failed: u64,
}

impl Tally {
    /// Adds a line such as `test result: ok. 3 passed; 0 failed; ...`; other lines count nothing.
    fn add(&mut self, line: &str) {
        let Some(result) = line.strip_prefix("test result: ") else { return };
        let words: Vec<&str> = result.split_whitespace().collect();
        for pair in words.windows(2) {
            let count = pair[0].parse().unwrap_or(0);
            match pair[1] {
                "passed;" => self.passed += count,
                "failed;" => self.failed += count,
                _ => {}
            }
        }
    }
}

/// Property tests draw their cases from this seed, so that one commit always gets one verdict;
/// `cargo test` by hand draws new ones each time.
const PROPERTY_SEED: &str = "2011";

/// Runs the tests, passes their output on line by line and counts.
fn cargo_test(root: &Path, arguments: &str, tally: &mut Tally) -> Result<()> {
    let mut child = command(root, arguments)
        .env("PROPTEST_RNG_SEED", PROPERTY_SEED)
        .stdout(Stdio::piped())
        .spawn()
        .context("start cargo test")?;
    if let Some(output) = child.stdout.take() {
        for line in BufReader::new(output).split(b'\n') {
            let line = line.context("read the output of cargo test")?;
            let line = String::from_utf8_lossy(&line);
            println!("{line}");
            tally.add(&line);
        }
    }
    judge(child.wait().context("wait for cargo test")?)?;
    if tally.passed == 0 {
        bail!("no test ran");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_summed_and_other_lines_pass() {
        let mut tally = Tally::default();
        for line in [
            "running 7 tests",
            "test a ... ok",
            "test result: ok. 7 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.01s",
            "test result: FAILED. 2 passed; 3 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.01s",
        ] {
            tally.add(line);
        }
        assert_eq!(tally, Tally { passed: 9, failed: 3 });
    }

    #[test]
    fn a_failed_step_says_how_to_rerun_it() {
        let error = step("fmt", "cargo fmt --check", || bail!("no")).unwrap_err();
        assert!(format!("{error:#}").contains("rerun it with: cargo fmt --check: no"));
    }
}
