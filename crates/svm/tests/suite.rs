//! All tests of this crate's interface, one module a behaviour: one program to link.

mod bias;
mod bounds;
mod degenerate;
mod endings;
mod invariance;
mod optimality;
mod properties;
#[cfg(feature = "clarabel")]
mod reference;
mod regressions;
mod separation;
#[cfg(feature = "serde")]
mod serde;
mod support;
mod thin;
mod units;
