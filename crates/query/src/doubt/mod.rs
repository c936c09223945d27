//! What keeps a pair from reading as free, whatever the evidence says.

pub(crate) mod enclosed;
pub(crate) mod of_pair;
pub(crate) mod safeguards;
pub(crate) mod taken;
pub(crate) mod undecided;
pub(crate) mod unseen;
pub(crate) mod warning;
