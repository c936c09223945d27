//! Files of tests that no program of tests has: cargo passes them over in silence.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

/// The program that has all but those with a program of their own.
const SUITE: &str = "/tests/suite.rs";

/// The files beside a suite that neither it nor the manifest names.
pub(super) fn check(root: &Path, paths: &[String]) -> Result<Vec<String>> {
    let read =
        |path: &str| fs::read_to_string(root.join(path)).with_context(|| format!("read {path}"));
    let mut found = Vec::new();
    for suite in paths.iter().filter(|path| path.ends_with(SUITE)) {
        let folder = suite.trim_end_matches(SUITE);
        let known = read(suite)? + &read(&format!("{folder}/Cargo.toml"))?;
        let tests = format!("{folder}/tests/");
        let names = paths.iter().filter_map(|path| path.strip_prefix(&tests)?.strip_suffix(".rs"));
        let is_lost = |name: &&str| {
            !name.contains('/')
                && !known.contains(&format!("mod {name};"))
                && !known.contains(&format!("name = \"{name}\""))
        };
        found.extend(names.filter(is_lost).map(|name| format!("{tests}{name}.rs: not in {suite}")));
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_file_that_no_program_has_is_named() {
        let root = std::env::temp_dir().join(format!("xtask-suite-{}", std::process::id()));
        std::fs::create_dir_all(root.join("a/tests")).unwrap();
        std::fs::write(root.join("a/Cargo.toml"), "[[test]]\nname = \"suite\"\n").unwrap();
        std::fs::write(root.join("a/tests/suite.rs"), "mod b;\n").unwrap();
        let paths = ["suite", "b", "c", "d/mod"].map(|name| format!("a/tests/{name}.rs"));
        let found = super::check(&root, &paths).unwrap();
        std::fs::remove_dir_all(&root).unwrap();
        assert_eq!(found, ["a/tests/c.rs: not in a/tests/suite.rs"]);
    }
}
