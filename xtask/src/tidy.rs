//! `cargo xtask tidy`: rules that no compiler checks, each violation with its file.

mod circles;
mod layers;
mod manifest;
mod modules;
mod text;

use std::{fs, path::Path};

use anyhow::{Context, Result, bail};

/// Prints every violation and fails when there is one.
pub(crate) fn run(root: &Path) -> Result<()> {
    let violations = violations(root)?;
    if violations.is_empty() {
        println!("tidy: nothing to complain about");
        return Ok(());
    }
    bail!("{} violations\n  {}", violations.len(), violations.join("\n  "))
}

fn violations(root: &Path) -> Result<Vec<String>> {
    let manifests = manifest::read_all(root)?;
    let mut found = layers::check(&manifests);
    found.extend(manifest::check(root, &manifests)?);
    let folders: Vec<&str> = manifests.iter().map(|m| m.folder.as_str()).collect();
    found.extend(circles::check(root, &folders)?);
    for path in files(root, root)? {
        let read = || fs::read_to_string(root.join(&path)).with_context(|| format!("read {path}"));
        if path.ends_with(".rs") {
            found.extend(text::check_rust(&path, &read()?));
        } else if path.ends_with(".md") {
            found.extend(text::check_prose(&path, &read()?));
        }
    }
    if !root.join("CHANGELOG.md").is_file() {
        found.push("CHANGELOG.md is missing".into());
    }
    Ok(found)
}

/// Files of the project, relative to its root, in order; not what git or cargo made.
fn files(root: &Path, folder: &Path) -> Result<Vec<String>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| format!("list {}", folder.display()))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with('.') || name == "target" {
            continue;
        }
        if path.is_dir() {
            paths.extend(files(root, &path)?);
        } else {
            let relative = path.strip_prefix(root).unwrap_or(&path);
            paths.push(relative.to_string_lossy().replace('\\', "/"));
        }
    }
    paths.sort();
    Ok(paths)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_workspace_is_tidy() {
        super::run(&crate::project_root()).unwrap();
    }
}
