//! Source and prose, line by line.

/// Longer than this, a file does more than one thing.
const LONGEST: usize = 500;

/// Left-overs that have no place in a library; split so that this file does not name them.
const LEFT_OVERS: [&str; 3] = [concat!("TO", "DO"), concat!("FIX", "ME"), concat!("print", "ln!(")];

/// Folders of other machines and of this one; a reader of the documents has neither.
const FOREIGN_FOLDERS: [&str; 5] = ["/work/", "/home/", "/root/", "/Users/", "/tmp/"];

/// What is wrong with a Rust file.
pub(super) fn check_rust(path: &str, text: &str) -> Vec<String> {
    let mut found = check_blanks(path, text);
    // A crate's documentation may be its README.
    if !text.starts_with("//! ") && !text.starts_with("#![doc = include_str!(") {
        found.push(format!("{path}:1: no module documentation (`//!`) at the top"));
    }
    let lines = text.lines().count();
    if lines > LONGEST {
        found.push(format!("{path}: {lines} lines, at most {LONGEST}: split it by what it does"));
    }
    if is_library(path) {
        for (number, line) in text.lines().enumerate() {
            // Documentation shows output to readers; that is not output of the library.
            let code = !line.trim_start().starts_with("//");
            for word in LEFT_OVERS {
                let is_call = word.ends_with('(');
                if line.contains(word) && (code || !is_call) {
                    found.push(format!("{path}:{}: `{word}` in a library", number + 1));
                }
            }
        }
    }
    found
}

/// What is wrong with a Markdown file.
pub(super) fn check_prose(path: &str, text: &str) -> Vec<String> {
    let mut found = check_blanks(path, text);
    for (number, line) in text.lines().enumerate() {
        for folder in FOREIGN_FOLDERS.iter().filter(|folder| names_folder(line, folder)) {
            found.push(format!("{path}:{}: `{folder}` is outside of the project", number + 1));
        }
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

/// The sources of what others link: not of the tool, the lab, the tasks, benches, tests, examples.
fn is_library(path: &str) -> bool {
    let talks = ["crates/cli/", "crates/evaluation/"];
    path.starts_with("crates/")
        && path.contains("/src/")
        && !talks.iter().any(|folder| path.starts_with(folder))
}

fn check_blanks(path: &str, text: &str) -> Vec<String> {
    let mut found = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let number = number + 1;
        if line.contains('\t') {
            found.push(format!("{path}:{number}: a tab"));
        }
        if line.ends_with([' ', '\r']) {
            found.push(format!("{path}:{number}: a blank at the end of the line"));
        }
    }
    if !text.is_empty() && !text.ends_with('\n') {
        found.push(format!("{path}: no line break at the end"));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIBRARY: &str = "crates/x/src/a.rs";

    #[test]
    fn good_files_pass() {
        assert!(check_rust(LIBRARY, "//! A module.\n\nfn f() {}\n").is_empty());
        assert!(
            check_rust("crates/x/src/lib.rs", "#![doc = include_str!(\"../README.md\")]\n")
                .is_empty()
        );
        assert!(check_prose("docs/a.md", "See crates/work/src and fixtures/tmp/x.\n").is_empty());
    }

    #[test]
    fn each_fault_of_a_source_is_named() {
        for (text, named) in [
            ("fn f() {}\n".to_owned(), "no module documentation"),
            ("//! A.\n\tf()\n".to_owned(), "a tab"),
            ("//! A.\nf() \n".to_owned(), "a blank"),
            ("//! A.\nf()".to_owned(), "no line break"),
            ("//! A.\n".to_owned() + &"\n".repeat(500), "501 lines"),
            (format!("//! A.\n// {} later\n", LEFT_OVERS[0]), LEFT_OVERS[0]),
            (format!("//! A.\n{}\"x\");\n", LEFT_OVERS[2]), LEFT_OVERS[2]),
        ] {
            let found = check_rust(LIBRARY, &text);
            assert!(found.len() == 1 && found[0].contains(named), "{named}: {found:?}");
        }
        let printing = format!("//! A.\n{}\"x\");\n", LEFT_OVERS[2]);
        assert!(check_rust("crates/cli/src/main.rs", &printing).is_empty());
        let documented = format!("//! A.\n/// {}\"x\");\n", LEFT_OVERS[2]);
        assert!(check_rust(LIBRARY, &documented).is_empty());
    }

    #[test]
    fn a_folder_outside_of_the_project_is_named() {
        for text in ["see /home/me/notes\n", "(/tmp/x)\n", "`/work/a`\n"] {
            assert_eq!(check_prose("docs/a.md", text).len(), 1, "{text}");
        }
    }
}
