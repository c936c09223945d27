//! Input that breaks careless numerics, each with a name and a reason.

mod bodies;
mod case;
mod layouts;
mod numbers;
mod problems;
mod shapes;

pub use bodies::{HardMesh, hard_meshes};
pub use case::HardCase;
pub use problems::{HardProblem, hard_problems};

/// All pairs of clouds, always the same; the largest cloud has 100,000 points.
pub fn hard_cases() -> Vec<HardCase> {
    [
        layouts::few_points(),
        layouts::flat(),
        layouts::repeated(),
        numbers::scales(),
        numbers::covariances(),
        numbers::not_finite(),
        shapes::shapes(),
    ]
    .concat()
}
