//! What can be wrong with the name of a link, in words.

/// How many names are told: a robot may have a hundred.
const MOST: usize = 5;

/// A link that the robot does not have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the robot has no link `{name}`: correct the name; the nearest there are: {near}")]
pub struct UnknownLink {
    /// The name.
    pub name: String,
    /// Those that are spelt most like it, the nearest first.
    pub near: String,
}

impl UnknownLink {
    pub(crate) fn new(name: &str, links: &[String]) -> Self {
        let small = name.to_lowercase();
        let mut near: Vec<&str> = links.iter().map(String::as_str).collect();
        near.sort_by_cached_key(|link| strsim::damerau_levenshtein(&small, &link.to_lowercase()));
        near.truncate(MOST);
        Self { name: name.to_owned(), near: near.join(", ") }
    }
}
