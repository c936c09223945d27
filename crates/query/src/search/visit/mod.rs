//! Down two trees to the pairs of leaves that may matter, and what leaves hold.

pub(super) mod around;
pub(super) mod ends;
pub(super) mod leaf;
pub(super) mod leaves;
pub(super) mod side;
pub(super) mod trees;
pub(super) mod unseen;
pub(super) mod within;
