//! Leaves that the caller knows all of beside the other tree.

/// Which leaf of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Settled {
    /// That of the first tree.
    A,
    /// That of the second tree.
    B,
}
