//! `cargo xtask ci`: every check, in order, each with its time; stops at the first failure.

use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result};
use cloudtouch_evaluation::sweep;

use crate::cargo::{AS_TESTED, RECORDINGS, cargo, example, succeed};
use crate::{fixtures, python, tidy};

/// Runs every step; tests come last, those in Python after those in Rust, whose build they use.
pub(crate) fn run(root: &Path) -> Result<()> {
    let with = |name: &str, arguments: &str, (variable, value): (&str, &str)| {
        step(name, &format!("{variable}='{value}' cargo {arguments}"), || {
            succeed(cargo(root, arguments).env(variable, value))
        })
    };
    let run = |name: &str, arguments: &str| {
        step(name, &format!("cargo {arguments}"), || succeed(&mut cargo(root, arguments)))
    };
    run("fmt", "fmt --all -- --check")?;
    step("tidy", "cargo xtask tidy", || tidy::run(root))?;
    step("fixtures", "cargo xtask fixtures --check", || fixtures::run(root, true))?;
    // The lock file holds: what is checked is what was committed, and no network is needed.
    run(
        "clippy",
        &format!("clippy --locked --workspace --all-targets {RECORDINGS} -- -D warnings"),
    )?;
    // The tool is left out: its binary and the library it wraps would share one page.
    let doc = "doc --locked --workspace --exclude cloudtouch-cli --no-deps --lib";
    let doc = format!("{doc} {AS_TESTED} {RECORDINGS}");
    with("doc", &doc, ("RUSTDOCFLAGS", "-D warnings"))?;
    let unpublished = tidy::unpublished(root)?;
    let exclude: String = unpublished.iter().map(|name| format!(" --exclude {name}")).collect();
    run("package", &format!("package --locked --workspace{exclude} --allow-dirty --no-verify"))?;
    step("sweep", "cargo xtask sweep --short", sweep::check)?;
    let test = format!("test --locked --workspace {RECORDINGS} --no-fail-fast");
    with("test", &test, ("PROPTEST_RNG_SEED", PROPERTY_SEED))?;
    // Tests build the examples too, and run none of them.
    let instructions = "run --locked --package cloudtouch-benches --example instructions";
    step("instructions", &format!("cargo {instructions}"), || {
        succeed(&mut example("instructions")?)
    })?;
    step("python", "cargo xtask python", || python::run(root))
}

/// Runs one step and says how long it took, or how to run it again.
fn step(name: &str, rerun: &str, action: impl FnOnce() -> Result<()>) -> Result<()> {
    println!("==> {name}: {rerun}");
    let start = Instant::now();
    action().with_context(|| format!("step {name} failed; rerun it with: {rerun}"))?;
    println!("==> {name}: ok in {:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}

/// Property tests draw their cases from this seed, so that one commit always gets one verdict;
/// `cargo test` by hand draws new ones each time.
const PROPERTY_SEED: &str = "2011";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_step_says_how_to_rerun_it() {
        let error = step("fmt", "cargo fmt --check", || anyhow::bail!("no")).unwrap_err();
        assert!(format!("{error:#}").contains("rerun it with: cargo fmt --check: no"));
    }
}
