//! The methods that ours is compared with: each takes two observed clouds and a pose, and gives a
//! score that is larger the more likely it holds a collision to be.

mod box_cells;
mod boxes;
mod distance;
mod error;
mod index;
mod observed;
mod plain_svm;
mod smallest;
mod smoothed;
#[cfg(test)]
mod test_boxes;
#[cfg(test)]
mod test_clouds;

use std::time::Instant;

pub(crate) use boxes::{BoxMap, ObjectMesh};
pub(crate) use distance::{CloudDistance, Distances};
pub(crate) use error::{RivalError, Side};
pub(crate) use index::Index;
pub(crate) use observed::{Observed, spread};
pub(crate) use plain_svm::PlainSvm;
pub(crate) use smoothed::SmoothedDistance;

/// What a method says of a pose, and what that cost on one thread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Answer {
    /// Larger for a more likely collision; only the order means something.
    pub score: f64,
    /// Probability of a collision, where the method states one.
    pub probability: Option<f64>,
    /// Time of the query itself, µs.
    pub micros: f64,
    /// Time of what has to be done once for the two clouds, whatever the pose, µs.
    pub prepare_micros: f64,
}

/// Microseconds since `start`.
fn micros_since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e6
}
