//! The map from the paper to the code names files, items and tests: each of them must exist.

use std::collections::BTreeSet;

use super::modules::ITEMS;

/// The page this is about.
pub(super) const PAGE: &str = "docs/paper-map.md";

/// Notes what a file declares, by its last name: items, fields, variants, and modules by its path.
pub(super) fn note(path: &str, text: &str, names: &mut BTreeSet<String>) {
    names.extend(path.trim_end_matches(".rs").split('/').map(str::to_owned));
    for line in text.lines() {
        let words: Vec<&str> = line
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .filter(|w| !w.is_empty())
            .collect();
        let is_item = |word: &str| word == "mod" || ITEMS.contains(&word);
        let after = |pair: &[&str]| is_item(pair[0]).then(|| pair[1].to_owned());
        names.extend(words.windows(2).filter_map(after));
        // A field, or a variant on a line of its own.
        let line = line.trim_start();
        let is_field = line.starts_with("pub ") && line.contains(':');
        let is_variant = line.starts_with(char::is_uppercase)
            && line[words.first().map_or(0, |w| w.len())..]
                .trim_start()
                .starts_with([',', '(', '{']);
        if is_field {
            names.extend(words.get(1).map(|w| (*w).to_owned()));
        } else if is_variant {
            names.extend(words.first().map(|w| (*w).to_owned()));
        }
    }
}

/// Names in code font of which there is nothing; `has_path` knows the paths below `crates/`.
pub(super) fn check(
    text: &str,
    names: &BTreeSet<String>,
    has_path: impl Fn(&str) -> bool,
) -> Vec<String> {
    let mut found = Vec::new();
    for (number, line) in text.lines().enumerate() {
        for code in line.split('`').skip(1).step_by(2).flat_map(alternatives) {
            let is_path = code.contains('/');
            // Commands, options and numbers are not names.
            let is_name = code.chars().all(|c| c.is_alphanumeric() || "_:".contains(c));
            let missing = if is_path {
                !code.contains(' ') && !has_path(&code)
            } else {
                is_name && code.split("::").any(|part| !names.contains(part))
            };
            if missing {
                found.push(format!("{PAGE}:{}: `{code}` is nowhere", number + 1));
            }
        }
    }
    found
}

/// `a::{b,c}` as `a::b` and `a::c`.
fn alternatives(code: &str) -> Vec<String> {
    let Some((before, rest)) = code.split_once('{') else { return vec![code.to_owned()] };
    let Some((within, after)) = rest.split_once('}') else { return vec![code.to_owned()] };
    within
        .split(',')
        .flat_map(|one| alternatives(&format!("{before}{}{after}", one.trim())))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_nothing_are_found() {
        let source = "pub struct Query {\n    pub gamma: f64,\n}\nenum Kind {\n    Fast,\n}\nfn it_holds() {\n    helper(used);\n}\n";
        let mut names = BTreeSet::new();
        note("svm/src/smo.rs", source, &mut names);
        let check = |text: &str| check(text, &names, |path| path == "svm/src/smo.rs").len();
        assert_eq!(check("`Query::gamma`, `Kind::Fast`, `smo::it_holds`, `svm/src/smo.rs`\n"), 0);
        assert_eq!(check("`cargo xtask paper` and `--points`\n"), 0);
        assert_eq!(check("`Query::{gamma,delta}`, `svm/src/{smo,qp}.rs`, `it_broke`\n"), 3);
        // What is only used may be another's.
        assert_eq!(check("`helper`, `Query::used`\n"), 2);
    }
}
