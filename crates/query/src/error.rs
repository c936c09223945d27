//! What can be wrong with the input, in words.

use cloudtouch_bvh::TreeError;
use cloudtouch_geom::{CovarianceError, MeshError, Vector3};
use cloudtouch_noise::NoiseError;

use crate::filter::FilterError;

/// Why a cloud or a mesh could not be prepared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PrepareError {
    /// No point was left after filtering.
    #[error(
        "no point is left of {before} after filtering ({stages}): loosen the filter or check the file"
    )]
    NothingLeft {
        /// Points in the input.
        before: usize,
        /// What each stage removed.
        stages: String,
    },
    /// A coordinate is so large that squares and volumes leave the range of `f64`.
    #[error(
        "point {index} has the coordinate {value:e}, beyond 1e50 m: check the unit, or remove the \
         point"
    )]
    CoordinateRange {
        /// Which point kept by the filter, or vertex of the merged mesh, from 0.
        index: usize,
        /// What was found, m.
        value: f64,
    },
    /// A covariance of the input is not one.
    #[error("point {index}: {source}")]
    Covariance {
        /// Which point, from 0.
        index: usize,
        /// What is wrong with it.
        source: CovarianceError,
    },
    /// A given normal has no direction.
    #[error(
        "point {index}: normal {normal:?} has no direction; leave the normals out to have them fitted"
    )]
    Normal {
        /// Which of the points that were kept, from 0.
        index: usize,
        /// The normal given.
        normal: Vector3,
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

/// A mesh takes more parts than allowed to be sampled as densely as asked.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "samples of the mesh at a spacing of {spacing} m take more than {max_parts} triangles: sample \
     it less densely, or raise the limit on parts"
)]
pub struct SubdivisionError {
    /// Longest edge wanted, m.
    pub spacing: f64,
    /// Triangles allowed, before and after splitting.
    pub max_parts: usize,
}

/// A query setting that is out of range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// Two numbers that are no interval of probabilities.
    #[error("{name} = [{lowest}, {highest}]: need 0 <= lowest <= highest <= 1")]
    NotAnInterval {
        /// Which setting.
        name: &'static str,
        /// Its lower end.
        lowest: f64,
        /// Its upper end.
        highest: f64,
    },
    /// A slope of a recalibration has the wrong sign.
    #[error(
        "recalibration: more evidence ({name}) would make a collision less probable; \
         leave it out of the fit, with a slope of 0"
    )]
    Slope {
        /// Whose slope.
        name: &'static str,
    },
    /// A number that has to be finite.
    #[error("{name} = {value}: must be finite")]
    NotFinite {
        /// Which setting.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The thresholds are not 0 ≤ reject ≤ ½ ≤ accept ≤ 1.
    #[error(
        "thresholds accept = {accept}, reject = {reject}: need 0 <= reject <= 0.5 <= accept <= 1"
    )]
    Thresholds {
        /// Probability above which a pair is in collision.
        accept: f64,
        /// Probability below which a pair is free.
        reject: f64,
    },
    /// A setting is not a positive finite number.
    #[error("{name} is {value}: give a positive finite number")]
    NotPositive {
        /// Which setting.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A probability or tolerance is not strictly between 0 and 1.
    #[error("{name} is {value}: give a number between 0 and 1, ends excluded")]
    NotAFraction {
        /// Which setting.
        name: &'static str,
        /// What was given.
        value: f64,
    },
}

/// Why a query has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QueryError {
    /// The pose has an entry that is NaN, infinite, or a translation beyond 1e50 m.
    #[error("the pose contains {value:e}: every entry must be finite, and at most 1e50 m")]
    Pose {
        /// What was found.
        value: f64,
    },
    /// A mesh cannot be sampled as densely as the cloud that it faces.
    #[error(transparent)]
    Subdivision(#[from] SubdivisionError),
    /// The trees could not be traversed.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// The two shapes cannot be tested against each other exactly.
    #[error("the two meshes cannot be tested against each other: is one of them degenerate?")]
    Unsupported,
}
