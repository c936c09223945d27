//! What a sweep consists of: one grid of conditions for every report.

use super::scenes::Scenes;
use crate::answers::{Condition, Pair};

/// What ours is called in tables and files.
pub const OURS: &str = "calibrated";
/// ... and ours given every sampled point as it truly is.
pub const ORACLE: &str = "oracle";
/// ... and ours without the classifier.
pub const GEOMETRY: &str = "geometry alone";

/// Standard deviations of the noise, m.
pub(super) const STDS: [f64; 4] = [0.0, 0.002, 0.01, 0.02];
/// Points of each cloud that results are pooled over.
pub(super) const POINTS: [usize; 2] = [2_500, 10_000];

/// Which scenes are asked about, how observed, and at how many poses.
#[derive(Clone)]
pub struct Plan {
    /// Generators of scenes.
    pub families: Vec<Scenes>,
    /// Draws of each family: a variant of its scene with poses and fresh clouds of its own.
    pub draws: u32,
    /// Poses of each draw.
    pub poses: usize,
    /// What the moving body is given as.
    pub pairs: Vec<Pair>,
    /// How every draw is observed.
    pub conditions: Vec<Condition>,
    /// Distinguishes draws of different use: constants are not fitted on what is judged.
    pub stream: u64,
}

impl Plan {
    /// Every generated family and kind of pair under every noise and density.
    pub fn full(draws: u32, poses: usize) -> Self {
        let of_points = |points| STDS.map(|std| Condition { points, std });
        Self {
            families: Scenes::generated(),
            draws,
            poses,
            pairs: Pair::ALL.to_vec(),
            conditions: POINTS.into_iter().flat_map(of_points).collect(),
            stream: 0,
        }
    }

    /// The same, drawn apart from [`Self::full`].
    pub fn evidence(draws: u32, poses: usize) -> Self {
        Self { stream: 1, ..Self::full(draws, poses) }
    }

    /// Of clouds far denser than they are sharp, drawn apart too.
    pub fn dense(draws: u32, poses: usize) -> Self {
        let of_points = |points| Condition { points, std: 0.02 };
        let conditions = [10_000, 40_000, 120_000].map(of_points).to_vec();
        Self { stream: 2, conditions, ..Self::full(draws, poses) }
    }
}
