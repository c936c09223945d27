//! What a report warns of: signs of a slip beside the answer.

mod code;
mod words;

pub(crate) use words::length;

use std::fmt;

use serde::Serialize;

use crate::doubt::undecided::Undecided;

/// Which of the two bodies of a query; the tool calls the first the scene, the second the object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Which {
    /// A.
    #[serde(rename = "scene")]
    A,
    /// B.
    #[serde(rename = "object")]
    B,
}

impl fmt::Display for Which {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::A => "scene",
            Self::B => "object",
        })
    }
}

/// A sign that a file, a unit, a pose or a sensor is not what was meant. Displays as a sentence with
/// a remedy; in a report it serialises as `{"code","values","words"}`, with [its code](Self::code).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(remote = "Self", untagged)]
#[non_exhaustive]
pub enum Warning {
    /// The points of a cloud, or all corners of each face of a mesh, are on a line: no surface.
    NoSurface {
        /// Whose.
        body: Which,
        /// How many there are.
        points: usize,
    },
    /// So many rows of a cloud without image layout have no return.
    Missing {
        /// Whose.
        body: Which,
        /// Share of the rows, 0 to 1.
        share: f64,
    },
    /// Sizes that a scene and an object hardly have.
    Units {
        /// Which of them is so large.
        body: Which,
        /// Diagonal of its box, m.
        size_m: f64,
        /// Diagonal of the other's box, m.
        other_size_m: f64,
    },
    /// The object is so far off that its pose, or a unit, cannot be meant.
    FarAway {
        /// Between the two boxes, m.
        gap_m: f64,
        /// Diagonal of the larger box, m.
        size_m: f64,
    },
    /// The other body fits between two points of a cloud.
    Sparse {
        /// Whose points.
        body: Which,
        /// Typical distance of neighbours, m.
        spacing_m: f64,
        /// Diagonal of the other's box, m.
        other_size_m: f64,
    },
    /// Points lie in clumps, between which no surface is known.
    Clumps {
        /// Whose points.
        body: Which,
        /// Typical distance of neighbours in a clump, m.
        across_m: f64,
        /// Typical distance of those in other clumps, m.
        apart_m: f64,
    },
    /// The noise of a cloud is larger than the other body.
    Noise {
        /// Whose noise.
        body: Which,
        /// Typical standard deviation, m.
        std_m: f64,
        /// Diagonal of the other's box, m.
        other_size_m: f64,
    },
    /// Far more noise is stated for a cloud than its points have: nearby, probabilities mean nothing.
    NoiseOverstated {
        /// Whose noise.
        body: Which,
        /// Typical standard deviation stated across its surface, m.
        std_m: f64,
        /// Typical standard deviation of its points from planes, m.
        seen_m: f64,
    },
    /// Coordinates were kept in single precision, far from the origin of their frame.
    Rounded {
        /// Whose.
        body: Which,
        /// How far apart they are there, m: more than the noise of a cloud.
        step_m: f64,
    },
    /// So many points are beside or behind the camera that is said to have seen them.
    SensorPose {
        /// Whose.
        body: Which,
        /// Share of the points, 0 to 1.
        share: f64,
    },
    /// So many points are behind the camera by the turn stated for it: it counts as looking along z instead.
    SensorTurn {
        /// Whose.
        body: Which,
        /// Share of the points, 0 to 1.
        share: f64,
    },
    /// The sensor does not see so far.
    SensorRange {
        /// Whose.
        body: Which,
        /// Median distance of the points, m.
        range_m: f64,
        /// How far it sees, m.
        limit_m: f64,
    },
    /// A laser scanner is stated for what is laid out as the image of a camera.
    SensorLayout {
        /// Whose.
        body: Which,
    },
    /// A camera, or a laser scanner and where it stood, is stated for a cloud without image layout: what it did not see is
    /// not known.
    NoImage {
        /// Whose.
        body: Which,
    },
    /// A cloud whose rows and columns no camera, or no laser scanner, at the place stated for it has.
    ImagePlace {
        /// Whose.
        body: Which,
    },
    /// So many points of a cloud were taken for the robot itself.
    SelfFilter {
        /// Whose.
        body: Which,
        /// Share of the points, 0 to 1.
        share: f64,
    },
    /// No point of a cloud lies on the robot that was to be left out of it.
    NoRobot {
        /// Whose.
        body: Which,
    },
    /// So many of the points that were taken for the robot itself are farther from it than their noise tells.
    Padding {
        /// Whose.
        body: Which,
        /// Share of the points that were left out, 0 to 1.
        share: f64,
    },
    /// The object is outside of the scene's box.
    OutsideScene {
        /// Between the two boxes, m.
        gap_m: f64,
        /// Diagonal of the scene's box, m.
        size_m: f64,
    },
    /// Scene and object are as if exchanged, or one of them is in another unit: the object is many times as large.
    Exchanged {
        /// Diagonal of the object's box, m.
        size_m: f64,
        /// Diagonal of the scene's box, m.
        other_size_m: f64,
    },
    /// Surface of a body lies where the depth image of the other saw nothing.
    Unseen {
        /// Whose surface.
        body: Which,
        /// Share of it, 0 to 1.
        share: f64,
        /// What is allowed.
        limit: f64,
    },
    /// Surface of a body lies close behind what the depth image of the other saw, and may be inside it.
    CloseBehind {
        /// Whose surface.
        body: Which,
        /// Share of it, 0 to 1.
        share: f64,
        /// What is allowed.
        limit: f64,
    },
    /// Surface of a body lies where points of the other were taken for the robot, though farther from it than their noise
    /// tells and with others beside them that stayed.
    TakenForRobot {
        /// Whose surface.
        body: Which,
        /// Share of it, 0 to 1.
        share: f64,
        /// What is allowed.
        limit: f64,
    },
    /// The camera of a depth image looked past most of where the robot is said to have been.
    RobotElsewhere {
        /// Which body.
        body: Which,
        /// Share of the surface of the robot, or of one of its links, that it could have seen, 0 to 1.
        share: f64,
    },
    /// No answer about these bodies is below the threshold for free: with nothing near it is as small as can be.
    RejectBelowLeast {
        /// The threshold ([`QuerySettings::reject`](crate::QuerySettings::reject)).
        reject: f64,
        /// The least probability of the two.
        least: f64,
    },
    /// Two poses of a path are half a turn apart, or so nearly that rounding decides which way round it goes.
    HalfTurn {
        /// The first of the two, counted from 0.
        pose: usize,
    },
}

impl Warning {
    /// Whom it is about; `None` where it is about how they lie to one another.
    pub(crate) fn body(&self) -> Option<Which> {
        match *self {
            Self::NoSurface { body, .. }
            | Self::Missing { body, .. }
            | Self::Units { body, .. }
            | Self::Sparse { body, .. }
            | Self::Clumps { body, .. }
            | Self::Noise { body, .. }
            | Self::NoiseOverstated { body, .. }
            | Self::Rounded { body, .. }
            | Self::SensorPose { body, .. }
            | Self::SensorTurn { body, .. }
            | Self::SensorRange { body, .. }
            | Self::SensorLayout { body }
            | Self::NoImage { body }
            | Self::NoRobot { body }
            | Self::ImagePlace { body }
            | Self::SelfFilter { body, .. }
            | Self::Padding { body, .. }
            | Self::Unseen { body, .. }
            | Self::CloseBehind { body, .. }
            | Self::TakenForRobot { body, .. }
            | Self::RobotElsewhere { body, .. } => Some(body),
            Self::FarAway { .. }
            | Self::OutsideScene { .. }
            | Self::Exchanged { .. }
            | Self::RejectBelowLeast { .. }
            | Self::HalfTurn { .. } => None,
        }
    }

    /// Why nothing reads as free beside this; `None` where it may.
    pub(crate) fn undecides(&self) -> Option<Undecided> {
        match self {
            Self::NoSurface { .. } => Some(Undecided::NoSurface),
            Self::Missing { .. }
            | Self::SelfFilter { .. }
            | Self::TakenForRobot { .. }
            | Self::RobotElsewhere { .. } => Some(Undecided::Missing),
            Self::Units { .. } | Self::FarAway { .. } => Some(Undecided::Units),
            Self::Sparse { .. } | Self::Clumps { .. } => Some(Undecided::Sparse),
            Self::Noise { .. } | Self::NoiseOverstated { .. } => Some(Undecided::Noise),
            Self::Rounded { .. } => Some(Undecided::Rounded),
            Self::SensorPose { .. } | Self::SensorRange { .. } | Self::ImagePlace { .. } => {
                Some(Undecided::Sensor)
            }
            Self::Unseen { .. } | Self::CloseBehind { .. } => Some(Undecided::Unseen),
            Self::SensorTurn { .. }
            | Self::SensorLayout { .. }
            | Self::NoImage { .. }
            | Self::NoRobot { .. }
            | Self::Padding { .. }
            | Self::OutsideScene { .. }
            | Self::Exchanged { .. }
            | Self::RejectBelowLeast { .. }
            | Self::HalfTurn { .. } => None,
        }
    }
}
