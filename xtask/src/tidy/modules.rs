//! The modules of a crate, and which items of one another they use.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Names from the outermost to the innermost, as in `super::pool::max`.
type Names = Vec<String>;

/// One module: the declarations of its file that matter here.
#[derive(Debug, Default)]
pub(super) struct Module {
    /// Where it is written; a module in braces shares the file of the one around it.
    pub(super) file: String,
    /// Modules declared without a body, which have files of their own.
    pub(super) declared: BTreeSet<String>,
    items: BTreeSet<String>,
    imports: Vec<Import>,
    /// Paths and single names anywhere but in `use` at the top.
    mentions: BTreeSet<Names>,
}

#[derive(Debug)]
struct Import {
    /// What it is called here; `*` for everything.
    name: String,
    path: Names,
    is_public: bool,
}

/// All modules of a crate by their names from the root, which is the empty list.
pub(super) type Modules = BTreeMap<Names, Module>;

/// Adds the module written in `text`, and those in braces within it. Test code is passed over.
pub(super) fn read(name: &[String], file: &str, text: TokenStream, all: &mut Modules) {
    let mut module = Module { file: file.to_owned(), ..Module::default() };
    let mut is_public = false;
    let mut rest = Vec::new();
    let mut tokens = text.into_iter().peekable();
    while let Some(token) = tokens.next() {
        match token.to_string().as_str() {
            "#" => {
                let attribute = tokens.next().map(|a| a.to_string().replace(' ', ""));
                if attribute.as_deref() == Some("[cfg(test)]") {
                    let ends = |t: &TokenTree| t.to_string() == ";" || braces(t).is_some();
                    tokens.by_ref().find(ends);
                }
            }
            "use" => {
                let tree = tokens.by_ref().take_while(|t| t.to_string() != ";").collect();
                for (name, path) in imported(tree, &[]) {
                    module.imports.push(Import { name, path, is_public });
                }
            }
            "mod" => {
                let child = tokens.next().map(|t| t.to_string()).unwrap_or_default();
                match tokens.next().as_ref().and_then(braces) {
                    Some(body) => read(&[name, &[child]].concat(), file, body, all),
                    None => drop(module.declared.insert(child)),
                }
            }
            word if ITEMS.contains(&word) => {
                module.items.extend(tokens.peek().map(ToString::to_string));
            }
            // Only a `use` asks for it; the reach of `pub(super)` comes in between.
            "pub" => {
                is_public = true;
                continue;
            }
            _ => {
                let is_reach = is_public && braces(&token).is_none();
                rest.push(token);
                if is_reach {
                    continue;
                }
            }
        }
        is_public = false;
    }
    mention(rest.into_iter().collect(), &mut module.mentions);
    all.insert(name.to_vec(), module);
}

/// Words before the name of an item.
pub(super) const ITEMS: [&str; 8] =
    ["const", "enum", "fn", "static", "struct", "trait", "type", "union"];

fn braces(token: &TokenTree) -> Option<TokenStream> {
    match token {
        TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => Some(group.stream()),
        _ => None,
    }
}

/// What a `use` brings, as the name here and the path.
fn imported(tree: TokenStream, before: &[String]) -> Vec<(String, Names)> {
    let (mut all, mut path, mut name) = (Vec::new(), before.to_vec(), None);
    let mut tokens = tree.into_iter();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Ident(ident) if ident == "as" => name = tokens.next().map(|t| t.to_string()),
            TokenTree::Ident(ident) => path.push(ident.to_string()),
            TokenTree::Punct(punct) if punct.as_char() == '*' => path.push("*".into()),
            TokenTree::Group(group) => {
                let parts: Vec<_> = group.stream().into_iter().collect();
                for part in parts.split(|t| t.to_string() == ",") {
                    all.extend(imported(part.iter().cloned().collect(), &path));
                }
                return all;
            }
            _ => {}
        }
    }
    if path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    if let Some(last) = path.last().filter(|_| path.len() > before.len() || !before.is_empty()) {
        all.push((name.unwrap_or_else(|| last.clone()), path));
    }
    all
}

/// Notes every chain of names, in brackets of any kind too, and what a `use` in a body brings.
fn mention(tokens: TokenStream, mentions: &mut BTreeSet<Names>) {
    // Names with nothing but a double colon between them are one word.
    let mut words = String::new();
    let mut tokens = tokens.into_iter();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Ident(word) if word == "use" => {
                let tree = tokens.by_ref().take_while(|t| t.to_string() != ";").collect();
                mentions.extend(imported(tree, &[]).into_iter().map(|(_, path)| path));
            }
            TokenTree::Ident(word) => words += &format!(" {word} "),
            TokenTree::Punct(punct) => words.push(punct.as_char()),
            TokenTree::Group(group) => {
                words.push(';');
                mention(group.stream(), mentions);
            }
            TokenTree::Literal(_) => words.push(';'),
        }
    }
    let words = words.replace(" :: ", "::");
    let chains = words.split(|c: char| c != ':' && c != '_' && !c.is_alphanumeric());
    mentions.extend(chains.map(|chain| chain.split("::").map(str::to_owned).collect()));
}

/// The files whose items each file uses, itself left out. A re-export alone uses nothing.
pub(super) fn uses(all: &Modules) -> BTreeMap<&str, BTreeSet<&str>> {
    let mut edges: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (name, module) in all {
        let of_file = edges.entry(&module.file).or_default();
        let wanted = |import: &&Import| {
            !import.is_public || module.mentions.iter().any(|m| m.first() == Some(&import.name))
        };
        let imported = module.imports.iter().filter(wanted).map(|import| &import.path);
        for path in imported.chain(&module.mentions) {
            of_file.extend(owner(all, name, path, 0, true).filter(|file| *file != module.file));
        }
    }
    edges
}

/// The file of the module that defines what a path in module `at` leads to; `None` for a module
/// as a whole and for what is not of this crate. What a `use` names does not come `by_glob` of the same
/// module: else two globs of other crates would lead to one another, time and again.
fn owner<'a>(
    all: &'a Modules,
    at: &[String],
    path: &[String],
    depth: usize,
    by_glob: bool,
) -> Option<&'a str> {
    /// Names that are re-exported more often than this go round in circles.
    const DEPTH: usize = 20;
    let (first, rest) = path.split_first().filter(|_| depth < DEPTH)?;
    let module = all.get(at)?;
    let child = [at, std::slice::from_ref(first)].concat();
    match first.as_str() {
        "crate" => return owner(all, &[], rest, depth + 1, true),
        "self" => return owner(all, at, rest, depth + 1, true),
        "super" => return owner(all, &at[..at.len().checked_sub(1)?], rest, depth + 1, true),
        "*" => return (!module.items.is_empty()).then_some(&module.file),
        _ if !rest.is_empty() && all.contains_key(&child) => {
            return owner(all, &child, rest, depth + 1, true);
        }
        _ if module.items.contains(first) => return Some(&module.file),
        _ => {}
    }
    module.imports.iter().find_map(|import| {
        let onwards = match import.name.as_str() {
            "*" if by_glob => [&import.path[..import.path.len() - 1], path].concat(),
            name if name == first => [&import.path[..], rest].concat(),
            _ => return None,
        };
        // A path that leads to itself, as `use serde` in a module, is of another crate.
        (onwards != path).then(|| owner(all, at, &onwards, depth + 1, false)).flatten()
    })
}
