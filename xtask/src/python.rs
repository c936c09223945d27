//! `cargo xtask python`: builds the Python package as `pip` does, checks its types and runs its tests.

use std::env::consts::EXE_SUFFIX;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};

use crate::cargo::{AS_TESTED, RECORDINGS, cargo, succeed};

/// Says why this Python is of no use, and nothing where it is.
const LOOK: &str = "\
import sys
if sys.version_info < (3, 9): sys.exit('it is Python %d.%d, and 3.9 is needed' % sys.version_info[:2])
try: import ensurepip, venv
except ImportError as error: sys.exit('%s: install its venv (Debian: apt install python3-venv)' % error)
";

/// Builds and tests, or prints why that cannot be done here.
pub(crate) fn run(root: &Path) -> Result<()> {
    if let Some(reason) = unusable("python3") {
        println!("python: skipped: {reason}");
        return Ok(());
    }
    // Absolute: what is started below runs in another folder.
    let target = root.join(std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into()));
    let folder = root.join("crates/python");
    let environment = target.join("python/venv");
    if !environment.exists() {
        succeed(Command::new("python3").args(["-m", "venv"]).arg(&environment))?;
    }
    let scripts = environment.join(if cfg!(windows) { "Scripts" } else { "bin" });
    // As an activated environment has it: pip looks for maturin there.
    let known = std::env::var_os("PATH").unwrap_or_default();
    let path =
        std::env::join_paths([scripts.clone()].into_iter().chain(std::env::split_paths(&known)))
            .context("put the environment into PATH")?;
    let python = || {
        let mut command = Command::new(scripts.join(format!("python{EXE_SUFFIX}")));
        command.env("PATH", &path);
        // The profile of the other steps: what they have built with the same features is there.
        command.current_dir(&folder).env("CARGO_TARGET_DIR", &target);
        command.env("MATURIN_PEP517_ARGS", "--profile dev");
        command
    };
    let install = |what: &str| {
        let pip = "-m pip install --quiet --disable-pip-version-check";
        succeed(python().args(pip.split_whitespace()).args(what.split_whitespace()))
    };
    // Not in isolation, for which pip would ask the network each time.
    install("maturin>=1.9,<2")?;
    install("--no-build-isolation .[test]")?;
    succeed(python().args(["-m", "mypy"]))?;
    // The tool is what answers are compared with, in the build that the tests of all crates left.
    let tool =
        format!("build --quiet --locked --workspace --bin cloudtouch {AS_TESTED} {RECORDINGS}");
    succeed(&mut cargo(root, &tool))?;
    let tool = target.join("debug").join(format!("cloudtouch{EXE_SUFFIX}"));
    succeed(python().args(["-m", "pytest", "--quiet"]).env("CLOUDTOUCH_TOOL", tool))
}

/// Why a Python cannot build and test; `None` where it can.
fn unusable(python: &str) -> Option<String> {
    match Command::new(python).args(["-c", LOOK]).output() {
        Ok(output) if output.status.success() => None,
        Ok(output) => Some(String::from_utf8_lossy(&output.stderr).trim().to_owned()),
        Err(error) => Some(format!("{python}: {error}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_said() {
        let reason = unusable("a-python-that-nobody-has").unwrap();
        assert!(reason.starts_with("a-python-that-nobody-has: "), "{reason}");
    }
}
