//! Manifests: what every crate says, inherits and ships.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use toml::{Table, Value};

/// The kinds of dependency a manifest has.
pub(super) const KINDS: [&str; 3] = ["dependencies", "build-dependencies", "dev-dependencies"];

/// One member's Cargo.toml.
pub(super) struct Manifest {
    /// Its folder, relative to the project.
    pub(super) folder: String,
    pub(super) table: Table,
}

impl Manifest {
    pub(super) fn name(&self) -> &str {
        self.package("name").and_then(Value::as_str).unwrap_or("")
    }

    /// Whether it goes to the registry.
    pub(super) fn is_published(&self) -> bool {
        self.package("publish").and_then(Value::as_bool).unwrap_or(true)
    }

    /// Dependencies of one kind, each with what the manifest says of it.
    pub(super) fn dependencies(&self, kind: &str) -> impl Iterator<Item = (&String, &Value)> {
        self.table.get(kind).and_then(Value::as_table).into_iter().flatten()
    }

    fn package(&self, key: &str) -> Option<&Value> {
        self.table.get("package")?.get(key)
    }
}

/// The manifests of all members, in order of their folders.
pub(super) fn read_all(root: &Path) -> Result<Vec<Manifest>> {
    let mut folders = vec!["benches".to_owned(), "xtask".to_owned()];
    for entry in fs::read_dir(root.join("crates")).context("list crates/")? {
        folders.push(format!("crates/{}", entry?.file_name().to_string_lossy()));
    }
    folders.sort();
    let read = |folder: String| {
        let path = root.join(&folder).join("Cargo.toml");
        let text = fs::read_to_string(&path).with_context(|| format!("read {}", path.display()))?;
        let table = text.parse().with_context(|| format!("parse {}", path.display()))?;
        Ok(Manifest { folder, table })
    };
    folders.into_iter().map(read).collect()
}

/// Everything about a manifest but the layers and what `cargo package` checks.
pub(super) fn check(manifest: &Manifest) -> Vec<String> {
    let mut found = Vec::new();
    let mut complain = |what: String| found.push(format!("{}/Cargo.toml: {what}", manifest.folder));
    let inherits = |value: Option<&Value>| {
        value.and_then(|v| v.get("workspace")).and_then(Value::as_bool) == Some(true)
    };
    for key in ["version", "edition", "rust-version", "license"] {
        if !inherits(manifest.package(key)) {
            complain(format!("`{key}.workspace = true` is missing"));
        }
    }
    if !inherits(manifest.table.get("lints")) {
        complain("`[lints] workspace = true` is missing".into());
    }
    for kind in KINDS {
        for (name, value) in manifest.dependencies(kind) {
            if !inherits(Some(value)) {
                complain(format!("`{name}` is not inherited from the workspace's dependencies"));
            }
        }
    }
    found
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::tidy) fn manifest(text: &str) -> Manifest {
        Manifest { folder: "crates/x".into(), table: text.parse().unwrap() }
    }

    const GOOD: &str = "[package]\nname = 'x'\nversion.workspace = true\nedition.workspace = true\n\
        rust-version.workspace = true\nlicense.workspace = true\n[lints]\nworkspace = true\n\
        [dependencies]\nserde.workspace = true\n";

    #[test]
    fn a_good_manifest_passes_and_each_fault_is_named() {
        assert_eq!(check(&manifest(GOOD)), Vec::<String>::new());
        for (from, to, named) in [
            ("license.workspace = true", "license = 'MIT'", "license"),
            ("[lints]\nworkspace = true", "", "lints"),
            ("serde.workspace = true", "serde = '1'", "serde"),
        ] {
            let found = check(&manifest(&GOOD.replace(from, to)));
            assert!(found.len() == 1 && found[0].contains(named), "{from}: {found:?}");
        }
    }
}
