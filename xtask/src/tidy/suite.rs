//! Files of tests that no program of tests has: cargo passes them over in silence.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use toml::Value;

use super::manifest::Manifest;

/// The files beside the suite of a crate that neither it nor the manifest names.
pub(super) fn check(root: &Path, manifest: &Manifest, paths: &[String]) -> Result<Vec<String>> {
    let folder = format!("{}/tests/", manifest.folder);
    let suite = format!("{folder}suite.rs");
    if !paths.contains(&suite) {
        return Ok(Vec::new());
    }
    let text = fs::read_to_string(root.join(&suite)).with_context(|| format!("read {suite}"))?;
    let files = paths.iter().filter_map(|path| path.strip_prefix(&folder)?.strip_suffix(".rs"));
    let lost = lost(manifest, &text, files).into_iter();
    Ok(lost.map(|name| format!("{folder}{name}.rs: not in {suite}")).collect())
}

fn lost<'a>(
    manifest: &Manifest,
    suite: &str,
    files: impl Iterator<Item = &'a str>,
) -> Vec<&'a str> {
    let programs = manifest.table.get("test").and_then(Value::as_array);
    let is_program = |file: &str| {
        let name = |program: &Value| program.get("name").and_then(Value::as_str) == Some(file);
        programs.is_some_and(|programs| programs.iter().any(name))
    };
    let is_lost = |file: &&str| {
        !file.contains('/') && !is_program(file) && !suite.contains(&format!("mod {file};"))
    };
    files.filter(is_lost).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tidy::manifest::tests::manifest;

    #[test]
    fn a_file_that_no_program_has_is_named() {
        let manifest = manifest("[[test]]\nname = 'suite'\n[[test]]\nname = 'e'\n");
        let files = ["suite", "b", "c", "d/mod", "e"];
        assert_eq!(lost(&manifest, "mod b;\n", files.into_iter()), ["c"]);
    }
}
