//! No two modules of a crate use one another, by whatever way round.
//!
//! A parent that declares or re-exports its children uses none of them by that alone; a child that
//! uses an item of its parent, while the parent uses the child, is in a circle. What a type's methods
//! call is not seen, only paths and imports are.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow};

use super::modules::{Modules, read, uses};

/// The circles in the crates of `folders`.
pub(super) fn check<'a>(
    root: &Path,
    folders: impl Iterator<Item = &'a str>,
) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for folder in folders {
        for top in ["lib.rs", "main.rs"] {
            let source = root.join(folder).join("src");
            if source.join(top).is_file() {
                let mut modules = Modules::new();
                load(&source, &[], top, &mut modules)?;
                let circles = circles(uses(&modules));
                found
                    .extend(circles.into_iter().map(|c| format!("{folder}/src: in a circle: {c}")));
            }
        }
    }
    Ok(found)
}

/// Reads a file, and those of the modules it declares. A module from another folder (`#[path]`) has
/// no file where it is looked for, and cannot use anything of this crate.
fn load(source: &Path, name: &[String], file: &str, all: &mut Modules) -> Result<()> {
    let path = source.join(file);
    let text = fs::read_to_string(&path).with_context(|| format!("read {}", path.display()))?;
    let tokens = text.parse().map_err(|e| anyhow!("{}: {e}", path.display()))?;
    read(name, file, tokens, all);
    let declared = all.get(name).map(|module| module.declared.clone()).unwrap_or_default();
    for child in declared {
        let name = [name, &[child]].concat();
        let stem = name.join("/");
        let files = [format!("{stem}.rs"), format!("{stem}/mod.rs")];
        if let Some(file) = files.iter().find(|file| source.join(file).is_file()) {
            load(source, &name, file, all)?;
        }
    }
    Ok(())
}

/// The files that are in circles or between two, each with those of them it uses.
fn circles<'a>(mut uses: BTreeMap<&'a str, BTreeSet<&'a str>>) -> Vec<String> {
    loop {
        // What uses none of the others or is used by none is in no circle.
        let used: BTreeSet<&str> = uses.values().flatten().copied().collect();
        let kept: BTreeSet<&str> = uses
            .iter()
            .filter(|(file, of)| used.contains(*file) && !of.is_empty())
            .map(|(file, _)| *file)
            .collect();
        if kept.len() == uses.len() {
            break;
        }
        uses.retain(|file, _| kept.contains(file));
        uses.values_mut().for_each(|of| of.retain(|file| kept.contains(file)));
    }
    let told = |(file, of): (&str, BTreeSet<&str>)| {
        format!("{file} -> {}", of.into_iter().collect::<Vec<_>>().join(", "))
    };
    uses.into_iter().map(told).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The circles of a crate whose modules are given by file and text.
    fn of(files: &[(&str, &str)]) -> Vec<String> {
        let mut modules = Modules::new();
        for (file, text) in files {
            let stem = file.trim_end_matches(".rs").trim_end_matches("/mod");
            let name: Vec<String> = stem.split('/').map(str::to_owned).collect();
            let name = if stem == "lib" { Vec::new() } else { name };
            read(&name, file, text.parse().unwrap(), &mut modules);
        }
        circles(uses(&modules))
    }

    #[test]
    fn layers_and_re_exports_pass() {
        let lib = ("lib.rs", "mod a; mod b; pub use b::B; pub const LIMIT: f64 = 1.0;");
        for (a, b) in [
            ("pub struct A;", "use crate::a::A; pub struct B(A);"),
            // Through the parent that only re-exports.
            ("use crate::B; pub fn a(_: B) {}", "pub struct B;"),
            ("use super::LIMIT; pub fn a() {}", "pub struct B(f64); fn b() { crate::a::a() }"),
            // Test code does not count, and neither do words in text.
            (
                "pub fn a() {}",
                "use crate::a::a; pub struct B; #[cfg(test)] mod tests { use super::*; }",
            ),
            (
                "#[cfg(test)] use crate::B; /// [`crate::B`]\npub fn a() { f(\"crate::b::B\") }",
                "pub struct B; fn b() { crate::a::a() }",
            ),
            // Reach is not use.
            ("pub(in crate::b) fn a() {}", "pub struct B;"),
        ] {
            assert_eq!(of(&[lib, ("a.rs", a), ("b.rs", b)]), Vec::<String>::new(), "{a} | {b}");
        }
    }

    #[test]
    fn two_that_use_one_another_are_named_however_they_do_it() {
        let lib = ("lib.rs", "mod a; mod b; pub use {a::A, b::B};");
        for (a, b) in [
            ("use crate::b::B; pub struct A(B);", "use crate::a::A; pub struct B(A);"),
            ("use crate::{B}; pub struct A;", "use super::A as Other; pub struct B;"),
            ("pub struct A; fn f() { crate::b::f() }", "pub struct B; pub fn f(_: crate::A) {}"),
            ("pub struct A; fn f() { x!(a, crate::B) }", "pub struct B(super::a::A);"),
            ("use super::b; pub struct A(b::B);", "pub struct B; fn f() { use crate::a::A; }"),
            ("use crate::b::*; pub struct A;", "use crate::*; pub struct B(A);"),
        ] {
            let found = of(&[lib, ("a.rs", a), ("b.rs", b)]);
            assert!(
                found.starts_with(&["a.rs -> b.rs", "b.rs -> a.rs"].map(String::from)),
                "{a} | {b}: {found:?}"
            );
        }
    }

    /// Looking for a name in one led to the other and back, twice as often with every step: tidy took
    /// minutes.
    #[test]
    fn two_globs_of_other_crates_come_to_an_end() {
        let globs = "use one::prelude::*; use two::prelude::*; use three::prelude::*;";
        let a = format!("{globs} fn f() {{ one::g(); other::h(); }}");
        assert!(of(&[("lib.rs", "mod a;"), ("a.rs", &a)]).is_empty());
    }

    #[test]
    fn a_child_and_the_parent_that_uses_it_are_a_circle() {
        let of = |parent: &str| {
            let child = ("p/c.rs", "use super::P; pub fn c(_: P) {}");
            of(&[("lib.rs", "mod p;"), ("p/mod.rs", parent), child])
        };
        assert!(of("mod c; pub use c::c; pub struct P;").is_empty());
        for parent in [
            "mod c; pub struct P; fn p() { c::c(P) }",
            "mod c; pub use c::c; pub struct P; fn p() { c(P) }",
        ] {
            assert_eq!(of(parent), ["p/c.rs -> p/mod.rs", "p/mod.rs -> p/c.rs"], "{parent}");
        }
    }

    #[test]
    fn a_longer_way_round_is_told_in_full_and_what_only_leads_there_is_not() {
        let found = of(&[
            ("lib.rs", "mod a; mod b; mod c; mod d; mod e; mod g; mod h;"),
            ("a.rs", "use crate::b::f; pub fn f() {}"),
            ("b.rs", "use crate::c::f; pub fn f() {}"),
            ("c.rs", "use crate::a::f; pub fn f() {}"),
            ("d.rs", "use crate::e::f; use crate::a; pub fn f() { a::f() }"),
            ("e.rs", "use crate::d::f; use crate::h::f; pub fn f() {}"),
            ("g.rs", "use crate::a::f; pub fn f() {}"),
            ("h.rs", "pub fn f() {}"),
        ]);
        let circles =
            ["a.rs -> b.rs", "b.rs -> c.rs", "c.rs -> a.rs", "d.rs -> a.rs, e.rs", "e.rs -> d.rs"];
        assert_eq!(found, circles);
    }
}
