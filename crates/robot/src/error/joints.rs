//! What can be wrong with positions of joints, and with a path of them, in words.

use cloudtouch::SceneError;

/// Why positions of joints place no robot.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum JointsError {
    /// A joint that the robot does not have.
    #[error(
        "the robot has no joint `{name}` that moves: leave it out, or correct the name to one of {known}"
    )]
    Unknown {
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// Joints without a position; none is assumed.
    #[error("no position is given for {names}: give one for every joint that moves")]
    Missing {
        /// Those without one.
        names: String,
    },
    /// NaN or infinite.
    #[error("joint `{name}` is at {value}: give a finite number, in rad or m")]
    NotFinite {
        /// The joint.
        name: String,
        /// What was given.
        value: f64,
    },
    /// Beyond the limits.
    #[error(
        "joint `{name}` is at {value}, beyond its limits {lower} .. {upper} (rad or m): move it within \
         them{hint}"
    )]
    Limit {
        /// The joint.
        name: String,
        /// Where it is; of a joint that mimics another, by what that is given.
        value: f64,
        /// rad or m.
        lower: f64,
        /// rad or m.
        upper: f64,
        /// What may have been meant.
        hint: &'static str,
    },
    /// Away from where a limit without a range keeps it, which some write where none was set.
    #[error(
        "joint `{name}` is at {value}, and its <limit> keeps it at 0: lower and upper are left out or 0, as \
         where no limit was set; write both into the URDF{instead}"
    )]
    NoRange {
        /// The joint.
        name: String,
        /// Where it is; of a joint that mimics another, by what that is given.
        value: f64,
        /// What else may have been meant.
        instead: &'static str,
    },
    /// A joint that mimics another is given another position than that implies.
    #[error(
        "joint `{name}` mimics `{followed}`, by which it is at {implied}, not {value}: leave it out"
    )]
    Mimic {
        /// The joint.
        name: String,
        /// What it follows.
        followed: String,
        /// Where that puts it.
        implied: f64,
        /// What was given.
        value: f64,
    },
    /// A link is nowhere.
    #[error(transparent)]
    Place(#[from] SceneError),
}

/// Why a path of joints cannot be followed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PathError {
    /// No motion.
    #[error("the path has too few positions ({count}): give at least two")]
    TooFew {
        /// How many are given.
        count: usize,
    },
    /// No share of the path, or too fine a one.
    #[error("the tolerance is {value:?}: give a share of the path from 1e-5 to 1, such as 0.001")]
    Tolerance {
        /// What was given.
        value: f64,
    },
    /// A position that places no robot.
    #[error("position {} of the path: {error}", index + 1)]
    Joints {
        /// Which, from 0; the message counts from 1.
        index: usize,
        /// What is wrong with it.
        error: JointsError,
    },
}
