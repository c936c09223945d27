//! What keeps a query from a decision.

use std::fmt;

use serde::{Serialize, Serializer};

/// Why a verdict is [`Verdict::Undecided`](crate::Verdict::Undecided).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Undecided {
    /// More of a body's surface than [`Safeguards::max_unseen`](crate::Safeguards::max_unseen) lies
    /// where the single depth image of the other saw nothing: see [`Unseen`](crate::Unseen).
    Unseen,
    /// The surface of a cloud, or of a mesh that is closed but for a few triangles, is all around the other
    /// body: it is in a hollow space, or within a solid. A cloud that knows where its sensor stood tells which,
    /// and a mesh whose holes are filled.
    Enclosed,
    /// Sizes or distance of the bodies are implausible: one of them is in another unit.
    Units,
    /// One body fits between the points of the other, or these lie in clumps with nothing known between.
    Sparse,
    /// The noise stated for a cloud is larger than the other body, or far larger than its points have and
    /// not small beside the other body.
    Noise,
    /// Coordinates were kept in single precision far from the origin of their frame: finer than that nothing is
    /// known.
    Rounded,
    /// The points of a cloud span no surface: they are on a line, or are one.
    NoSurface,
    /// Too many rows of a cloud without image layout have no return, or were taken for the robot itself, which was
    /// elsewhere, or where something is beside it: what is there is not known.
    Missing,
    /// The sensor stated for a cloud cannot have seen it.
    Sensor,
    /// A classifier could not be trained.
    Unsolved,
    /// What was culled, cut short by a deadline, or too noisy to be told apart could still collide.
    Bounds,
}

impl Undecided {
    /// Its name in JSON and in Python.
    pub fn code(self) -> &'static str {
        match self {
            Self::Unseen => "unseen",
            Self::Enclosed => "enclosed",
            Self::Units => "units",
            Self::Sparse => "sparse",
            Self::Noise => "noise",
            Self::Rounded => "rounded",
            Self::NoSurface => "no_surface",
            Self::Missing => "missing",
            Self::Sensor => "sensor",
            Self::Unsolved => "unsolved",
            Self::Bounds => "bounds",
        }
    }
}

/// In words.
impl fmt::Display for Undecided {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unseen => "the sensor saw too little of where the object is",
            Self::Enclosed => {
                "one surface is all around the other: hollow or solid? Say where the sensor stood, or \
                 close the mesh"
            }
            Self::Units => "sizes or distance are implausible",
            Self::Sparse => "a body fits between points of the other, or between clumps of them",
            Self::Noise => "the noise is larger than a body, or than points scatter",
            Self::Rounded => "coordinates are known too coarsely",
            Self::NoSurface => "a cloud spans no surface",
            Self::Missing => "too many rows have no return, or were taken for the robot",
            Self::Sensor => "the sensor cannot have seen this cloud",
            Self::Unsolved => "a classifier could not be trained",
            Self::Bounds => "what was not looked at, or is too noisy, could still collide",
        })
    }
}

/// Its code.
impl Serialize for Undecided {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.code())
    }
}
