//! Source and prose, line by line.

/// Longer than this, a file does more than one thing.
const LONGEST: usize = 500;

/// Notes of what is left to do; split so that this file does not name them.
const LEFT_OVERS: [&str; 2] = [concat!("TO", "DO"), concat!("FIX", "ME")];

/// Folders of other machines and of this one; a reader of the documents has neither.
const FOREIGN_FOLDERS: [&str; 5] = ["/work/", "/home/", "/root/", "/Users/", "/tmp/"];

/// What is wrong with a Rust file, beyond what rustfmt and Clippy find.
pub(super) fn check_rust(path: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    // A crate's documentation may be its README.
    if !text.starts_with("//! ") && !text.starts_with("#![doc = include_str!(") {
        found.push(format!("{path}:1: no module documentation (`//!`) at the top"));
    }
    let lines = text.lines().count();
    if lines > LONGEST {
        found.push(format!("{path}: {lines} lines, at most {LONGEST}: split it by what it does"));
    }
    for word in LEFT_OVERS.iter().filter(|word| text.contains(**word)) {
        found.push(format!("{path}: `{word}`"));
    }
    found
}

/// What is wrong with a Markdown file.
pub(super) fn check_prose(path: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let number = number + 1;
        for folder in FOREIGN_FOLDERS.iter().filter(|folder| names_folder(line, folder)) {
            found.push(format!("{path}:{number}: `{folder}` is outside of the project"));
        }
        if line.contains('\t') || line.ends_with([' ', '\r']) {
            found.push(format!("{path}:{number}: a tab, or a blank at the end of the line"));
        }
    }
    if !text.is_empty() && !text.ends_with('\n') {
        found.push(format!("{path}: no line break at the end"));
    }
    found
}

/// Whether the line names this folder itself, and not one of the project that ends alike.
fn names_folder(line: &str, folder: &str) -> bool {
    line.match_indices(folder).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        before.is_none_or(|c| !c.is_alphanumeric() && !"._-/".contains(c))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_files_pass_and_each_fault_is_named() {
        for text in ["//! A module.\n\nfn f() {}\n", "#![doc = include_str!(\"../README.md\")]\n"] {
            assert!(check_rust("a.rs", text).is_empty(), "{text}");
        }
        assert!(check_prose("docs/a.md", "See crates/work/src and fixtures/tmp/x.\n").is_empty());
        for (text, named) in [
            ("fn f() {}\n".to_owned(), "no module documentation"),
            ("//! A.\n".to_owned() + &"\n".repeat(500), "501 lines"),
            (format!("//! A.\n// {} later\n", LEFT_OVERS[0]), LEFT_OVERS[0]),
        ] {
            let found = check_rust("a.rs", &text);
            assert!(found.len() == 1 && found[0].contains(named), "{named}: {found:?}");
        }
        for (text, named) in [
            ("\ta\n", "a tab"),
            ("a \n", "a blank"),
            ("a", "no line break"),
            ("see /home/me/notes\n", "`/home/`"),
            ("(/tmp/x)\n", "`/tmp/`"),
            ("`/work/a`\n", "`/work/`"),
        ] {
            let found = check_prose("a.md", text);
            assert!(found.len() == 1 && found[0].contains(named), "{named}: {found:?}");
        }
    }
}
