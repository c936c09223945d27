//! `cargo xtask tidy`: rules that no compiler checks, each violation with its file.

mod circles;
mod layers;
mod manifest;
mod map;
mod modules;
mod suite;
mod text;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use walkdir::{DirEntry, WalkDir};

/// Prints every violation and fails when there is one.
pub(crate) fn run(root: &Path) -> Result<()> {
    let violations = violations(root)?;
    let count = violations.len();
    ensure!(count == 0, "{count} violations\n  {}", violations.join("\n  "));
    println!("tidy: nothing to complain about");
    Ok(())
}

/// The members that do not go to the registry.
pub(crate) fn unpublished(root: &Path) -> Result<Vec<String>> {
    let mut manifests = manifest::read_all(root)?;
    manifests.retain(|manifest| !manifest.is_published());
    Ok(manifests.iter().map(|manifest| manifest.name().to_owned()).collect())
}

fn violations(root: &Path) -> Result<Vec<String>> {
    let manifests = manifest::read_all(root)?;
    let mut found = layers::check(&manifests);
    found.extend(manifests.iter().flat_map(manifest::check));
    found.extend(circles::check(root, manifests.iter().map(|m| m.folder.as_str()))?);
    let mut names = BTreeSet::new();
    let paths = files(root, root)?;
    for path in &paths {
        found.extend(check_file(root, path, &mut names)?);
    }
    for manifest in &manifests {
        found.extend(suite::check(root, manifest, &paths)?);
    }
    let map = fs::read_to_string(root.join(map::PAGE)).context(map::PAGE)?;
    let has_path = |path: &str| {
        let below = |folder: &str| root.join(folder).join(path.trim_end_matches('/')).exists();
        below("crates") || below("")
    };
    found.extend(map::check(&map, &names, has_path));
    Ok(found)
}

/// What is wrong with a file; notes the names that a source has.
fn check_file(root: &Path, path: &str, names: &mut BTreeSet<String>) -> Result<Vec<String>> {
    if root.join(path).is_symlink() {
        return Ok(vec![format!(
            "{path}: a symbolic link, of which a checkout on Windows makes a text file"
        )]);
    }
    let read = || fs::read_to_string(root.join(path)).with_context(|| format!("read {path}"));
    Ok(if path.ends_with(".rs") {
        let text = read()?;
        map::note(path, &text, names);
        text::check_rust(path, &text)
    } else if path.ends_with(".md") {
        text::check_prose(path, &read()?)
    } else {
        Vec::new()
    })
}

/// Files of the project, relative to its root, in order; not what git, cargo or npm made.
pub(crate) fn files(root: &Path, folder: &Path) -> Result<Vec<String>> {
    let is_ours = |entry: &DirEntry| {
        let name = entry.file_name().to_string_lossy();
        entry.depth() == 0 || !name.starts_with('.') && name != "target" && name != "node_modules"
    };
    let mut paths = Vec::new();
    for entry in WalkDir::new(folder).sort_by_file_name().into_iter().filter_entry(is_ours) {
        let entry = entry.with_context(|| format!("list {}", folder.display()))?;
        if !entry.file_type().is_dir() {
            let relative = entry.path().strip_prefix(root).unwrap_or(entry.path());
            paths.push(relative.to_string_lossy().replace('\\', "/"));
        }
    }
    Ok(paths)
}

#[cfg(test)]
mod tests {
    #[cfg(unix)]
    #[test]
    fn a_symbolic_link_is_named_and_not_followed() {
        let root = std::env::temp_dir().join(format!("xtask-tidy-{}", std::process::id()));
        std::fs::create_dir_all(root.join("a")).unwrap();
        std::fs::write(root.join("a/b.txt"), "b").unwrap();
        std::os::unix::fs::symlink("a", root.join("c")).unwrap();
        let files = super::files(&root, &root).unwrap();
        let found = super::check_file(&root, "c", &mut Default::default()).unwrap();
        std::fs::remove_dir_all(&root).unwrap();
        assert_eq!(files, ["a/b.txt", "c"]);
        assert!(found.len() == 1 && found[0].starts_with("c: a symbolic link"), "{found:?}");
    }
}
