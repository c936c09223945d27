//! All tests of this crate's interface, one module a behaviour: one program to link.

mod build;
mod certified;
mod common;
mod insert_remove;
mod invariance;
mod patch;
mod refit;
mod stochastic;
mod surfaces;
