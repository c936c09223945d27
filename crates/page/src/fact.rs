//! A line about an answer.

/// A name and what is to be said under it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fact {
    /// A few words.
    pub label: String,
    /// A sentence, or less.
    pub text: String,
}

impl Fact {
    /// Both from anything that is text.
    pub fn new(label: impl Into<String>, text: impl Into<String>) -> Self {
        Self { label: label.into(), text: text.into() }
    }
}
