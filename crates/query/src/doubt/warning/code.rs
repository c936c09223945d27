//! What programs know a warning by.

use serde::{Serialize, Serializer};

use super::Warning;

impl Warning {
    /// Its name in JSON, which stays as it is when words change.
    pub fn code(&self) -> &'static str {
        match self {
            Self::NoSurface { .. } => "no_surface",
            Self::Missing { .. } => "missing",
            Self::Units { .. } => "units",
            Self::FarAway { .. } => "far_away",
            Self::Sparse { .. } => "sparse",
            Self::Clumps { .. } => "clumps",
            Self::Noise { .. } => "noise",
            Self::NoiseOverstated { .. } => "noise_overstated",
            Self::Rounded { .. } => "rounded",
            Self::SensorPose { .. } => "sensor_pose",
            Self::SensorTurn { .. } => "sensor_turn",
            Self::SensorRange { .. } => "sensor_range",
            Self::SensorLayout { .. } => "sensor_layout",
            Self::NoImage { .. } => "no_image",
            Self::ImagePlace { .. } => "image_place",
            Self::SelfFilter { .. } => "self_filter",
            Self::NoRobot { .. } => "no_robot",
            Self::Padding { .. } => "padding",
            Self::OutsideScene { .. } => "outside_scene",
            Self::Exchanged { .. } => "exchanged",
            Self::Unseen { .. } => "unseen",
            Self::CloseBehind { .. } => "close_behind",
            Self::TakenForRobot { .. } => "taken_for_robot",
            Self::RobotElsewhere { .. } => "robot_elsewhere",
            Self::RejectBelowLeast { .. } => "reject_below_least",
            Self::HalfTurn { .. } => "half_turn",
        }
    }
}

/// With its code and its words.
impl Serialize for Warning {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Spelled<'a> {
            code: &'static str,
            // What is derived: an associated function of the same name.
            #[serde(serialize_with = "Warning::serialize")]
            values: &'a Warning,
            words: String,
        }
        Spelled { code: self.code(), values: self, words: self.to_string() }.serialize(serializer)
    }
}
