//! All tests of this crate's interface, one module a behaviour: one program to link.

mod bounds;
mod chance;
mod common;
mod degenerate;
mod dense;
mod ends;
mod neighborhoods;
mod outline;
mod posterior;
mod reach;
mod representatives;
mod sensors;
mod shared;
mod sigma;
