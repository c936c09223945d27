//! What can be wrong with the primitives, the settings or the pose.

use cloudtouch_geom::message::number;

/// Why a tree could not be built, changed or traversed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TreeError {
    /// A coordinate is NaN, infinite, or so large that the side of a box leaves the range of `f32`.
    #[error(
        "primitive {index} has the coordinate {}: coordinates must be finite and below 1e37 in \
         magnitude; drop missing returns before building",
        number(*value)
    )]
    Coordinate {
        /// Index of the primitive.
        index: usize,
        /// What was found, m.
        value: f64,
    },
    /// A covariance has an entry that is not finite or too large.
    #[error(
        "the covariance of primitive {index} has the entry {}: entries must be finite and below \
         1e74 in magnitude",
        number(*value)
    )]
    Covariance {
        /// Index of the primitive.
        index: usize,
        /// What was found, m².
        value: f64,
    },
    /// How far the surface of a primitive reaches has an entry that is not finite or too large.
    #[error(
        "the extent of primitive {index} has the entry {}: entries must be finite and below 1e74 in \
         magnitude",
        number(*value)
    )]
    Extent {
        /// Index of the primitive.
        index: usize,
        /// What was found, m².
        value: f64,
    },
    /// A weight is negative or not finite.
    #[error(
        "primitive {index} has the weight {}: weights must be finite and not negative",
        number(*value)
    )]
    Weight {
        /// Index of the primitive.
        index: usize,
        /// What was found.
        value: f64,
    },
    /// A setting is out of range.
    #[error("the setting `{name}` is {}: it must be {expected}", number(*value))]
    Setting {
        /// Name of the field.
        name: &'static str,
        /// What was found.
        value: f64,
        /// What is allowed.
        expected: &'static str,
    },
    /// More primitives than a 32-bit index can name.
    #[error("{count} primitives are too many: a tree holds fewer than 4294967295, so thin them")]
    TooMany {
        /// How many were given.
        count: usize,
    },
    /// Another number of primitives, or of what is set for each, was given than the tree has indices.
    #[error(
        "{found} were given for {expected} indices, removed ones included: pass one for each, or rebuild"
    )]
    Count {
        /// How many indices the tree has, removed ones included.
        expected: usize,
        /// How many were given.
        found: usize,
    },
    /// No primitive has this index, it was removed, was named before in the same list, or has no extent where that is
    /// replaced.
    #[error(
        "the tree has no primitive {index} that could be named here: it was never inserted, already removed, \
         named before, or has no extent"
    )]
    NoSuchPrimitive {
        /// The index asked for.
        index: usize,
    },
    /// A leaf bound is negative or NaN, or a shift or a reach infinite.
    #[error(
        "the bounds of leaf {leaf} are std {}, shift {} and reach {}: all must be zero or more, shift \
         and reach finite",
        number(*std), number(*shift), number(*reach)
    )]
    LeafBounds {
        /// Index of the leaf's node.
        leaf: usize,
        /// The standard deviation given, m.
        std: f64,
        /// The shift given, m.
        shift: f64,
        /// The reach given, m.
        reach: f64,
    },
    /// The pose has an entry that is not finite.
    #[error(
        "the pose has the entry {value}: it must be finite; check it with Pose::try_from_matrix"
    )]
    Pose {
        /// What was found.
        value: f64,
    },
    /// The tree breaks one of its own rules: a defect of this crate, found by `Tree::validate`.
    #[error("node {node} is malformed: {reason}")]
    Malformed {
        /// Index of the node.
        node: usize,
        /// The rule that is broken.
        reason: &'static str,
    },
}
