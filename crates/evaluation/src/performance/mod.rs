//! `cargo xtask bench-report`: how fast ours and its peers are on the same scenes, against the
//! targets.

mod asked;
mod batch;
mod first_query;
mod frames;
mod growth;
mod leaf_problems;
mod linfa;
mod memory;
mod methods;
mod prepared;
mod run;
mod scene;
mod solvers;
mod target;
mod timing;

pub use run::{Arguments, run};
