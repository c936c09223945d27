//! Why a body could not be prepared.

use cloudtouch_bvh::TreeError;
use cloudtouch_geom::message::{number, rounded};
use cloudtouch_geom::{MeshError, Vector3};
use cloudtouch_noise::NoiseError;

use super::filter::FilterError;

/// Why a cloud or a mesh could not be prepared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PrepareError {
    /// No point was left after filtering.
    #[error("{}", nothing_left(*before, stages))]
    NothingLeft {
        /// Points in the input.
        before: usize,
        /// What each stage removed.
        stages: String,
    },
    /// One of several scans cannot be used; its rows are counted from 0, as if it had been given alone.
    #[error("scan {} of {count}: {error}", scan + 1)]
    Scan {
        /// Which of the scans, counted from 0.
        scan: usize,
        /// How many there are.
        count: usize,
        /// What is wrong with it.
        error: Box<PrepareError>,
    },
    /// A scan that was merged before: what it says twice would count twice.
    #[error("scan {} is one of those before it, to the point: give each scan once", scan + 1)]
    RepeatedScan {
        /// Which of the scans, counted from 0.
        scan: usize,
    },
    /// A coordinate is so large that doubles do not tell micrometres apart there.
    #[error(
        "point {index} has the coordinate {}, beyond 1e10 m: check the unit, or remove the \
         point",
        number(*value)
    )]
    CoordinateRange {
        /// Which row of the cloud (cell, after a collision map) or vertex of the mesh, from 0.
        index: usize,
        /// What was found, m.
        value: f64,
    },
    /// The sensor is said to have stood where doubles do not tell micrometres apart.
    #[error(
        "the pose of the sensor contains {}: every entry must be finite, and at most 1e10 m; check its unit",
        number(*value)
    )]
    SensorPose {
        /// What was found.
        value: f64,
    },
    /// The noise is so large beside the cloud that its points say nothing.
    #[error(
        "the cloud is {} m across, and its noise is {} m (standard deviation): give the unit of the cloud, if that is not \
         metres, and the sensor's noise in metres, such as iso:0.005 for 5 mm{}",
        rounded(*size), rounded(*std), sensor_place(*range)
    )]
    NoiseBeyondSize {
        /// Median of the standard deviations, each the largest of its point, m.
        std: f64,
        /// Diagonal of the box around the points, m.
        size: f64,
        /// How far from the middle of that box the sensor is said to have stood, if anything is said, m; the
        /// farthest of several.
        range: Option<f64>,
    },
    /// A given normal is not of length one.
    #[error(
        "point {index}: normal {normal:?} is not of length one; leave the normals out to have them fitted"
    )]
    Normal {
        /// Which row of the cloud (cell, after a collision map), from 0.
        index: usize,
        /// The normal given.
        normal: Vector3,
    },
    /// There are not as many κ as points.
    #[error("the cloud kept {points} points and is given {kappas} kappas: give one for each")]
    KappaCount {
        /// Points that the filter kept.
        points: usize,
        /// What was given.
        kappas: usize,
    },
    /// The cleaning pipeline was asked for something impossible.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// The sensor model or the noise settings do not fit the cloud.
    #[error(transparent)]
    Noise(#[from] NoiseError),
    /// The tree could not be built.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// The mesh has nothing to collide with.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The mesh library refused the surface.
    #[error("the mesh surface cannot be used: {reason}")]
    Surface {
        /// What the library said.
        reason: String,
    },
}

/// Of an empty cloud no stage is to blame.
fn nothing_left(before: usize, stages: &str) -> String {
    if before == 0 {
        return "the cloud has no points: check where it comes from".to_owned();
    }
    format!(
        "no point is left of {before} after filtering ({stages}): loosen the filter, or check the file and \
         its unit"
    )
}

/// Noise that grows with the range is large where the sensor is not where it is said to be.
fn sensor_place(range: Option<f64>) -> String {
    range.map_or(String::new(), |range| {
        format!(
            "; the sensor is said to have stood {} m from its points: check that too",
            rounded(range)
        )
    })
}
