//! The sentence of each warning: what was seen, and what to do about it.

use std::fmt;

use cloudtouch_geom::message::rounded;

use super::{Warning, Which};

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.sign(), self.remedy())
    }
}

impl Warning {
    /// What was seen, with the colon or semicolon before the remedy.
    fn sign(&self) -> String {
        match *self {
            Self::NoSurface { body, points: 1 } => {
                format!("the {body} has all its points in one place: they span no surface;")
            }
            Self::NoSurface { body, points } => format!(
                "all {points} points or corners of the {body} are on a line: they span no surface;"
            ),
            Self::Missing { body, share } => part(
                (100.0 * share, "rows", body),
                "have no return, and without an image layout it is not known where:",
            ),
            Self::Units { body, size_m, other_size_m } => {
                let [size, other] = [size_m, other_size_m].map(length);
                format!("the {body} is {size} across and the other body {other}:")
            }
            Self::FarAway { gap_m, size_m } => {
                let [gap, size] = [gap_m, size_m].map(length);
                format!("the object is {gap} away from a scene {size} across:")
            }
            Self::Sparse { body, spacing_m, other_size_m } => {
                let [spacing, other] = [spacing_m, other_size_m].map(length);
                format!(
                    "points of the {body} are {spacing} apart and the other body is {other} across: it fits \
                     between them;"
                )
            }
            Self::Clumps { body, across_m, apart_m } => {
                let [across, apart] = [across_m, apart_m].map(length);
                format!(
                    "points of the {body} lie in clumps some {across} across and {apart} from one another, as many \
                     scans of the same rays do: nothing is known between them;"
                )
            }
            Self::Noise { body, std_m, other_size_m } => {
                let [std, other] = [std_m, other_size_m].map(length);
                format!("the noise of the {body} is {std} and the other body {other} across:")
            }
            Self::NoiseOverstated { body, std_m, seen_m } => {
                let [std, seen] = [std_m, seen_m].map(length);
                format!(
                    "the noise stated for the {body} is {std} and its points are {seen} off planes:"
                )
            }
            Self::Rounded { body, step_m } => format!(
                "coordinates of the {body} were kept in single precision, and where they are that tells places \
                 no finer than {}:",
                length(step_m)
            ),
            Self::SensorPose { body, share } => part(
                (percent_from(share), "points", body),
                "are beside or behind the camera stated for it:",
            ),
            Self::SensorTurn { body, share } => part(
                (100.0 * share, "points", body),
                "are behind the camera by the turn stated for it, which is not believed:",
            ),
            Self::SensorRange { body, range_m, limit_m } => {
                let [range, limit] = [range_m, limit_m].map(length);
                format!(
                    "points of the {body} are {range} away and its sensor sees no farther than {limit}:"
                )
            }
            Self::SensorLayout { body } => format!(
                "the {body} is laid out as the image of a camera and its sensor is stated as a laser scanner:"
            ),
            Self::NoImage { body } => format!(
                "the {body} has no rows and columns: what its sensor did not see counts as empty;"
            ),
            Self::ImagePlace { body } => format!(
                "the {body} has rows and columns as an image, which no sensor at the place stated for it has:"
            ),
            Self::SelfFilter { body, share } => {
                part((100.0 * share, "points", body), "were taken for the robot and left out:")
            }
            Self::NoRobot { body } => {
                format!("no point of the {body} lies on the robot that was to be left out:")
            }
            Self::Padding { body, share } => part(
                (100.0 * share, "points", body),
                "that were left out as the robot's are farther from it than their noise tells, and may be of \
                 what is beside it:",
            ),
            Self::OutsideScene { gap_m, size_m } => {
                let [gap, size] = [gap_m, size_m].map(length);
                format!("the object is outside of the scene, {gap} from its box of {size}:")
            }
            Self::Exchanged { size_m, other_size_m } => {
                let [size, other] = [size_m, other_size_m].map(length);
                format!("the object is {size} across and the scene {other}:")
            }
            Self::Unseen { body, share, limit } => {
                let limit = rounded(100.0 * limit);
                let lies = format!("lies where the sensor saw nothing (allowed: {limit} %):");
                part((percent_from(share), "surface", body), &lies)
            }
            Self::CloseBehind { body, share, limit } => {
                let [share, limit] = [share, limit].map(|part| 100.0 * part);
                format!(
                    "{share:.1} % of the surface of the {body} lies less than 3 cm behind what the sensor saw, and \
                     may be inside it (allowed: {limit:.1} %):"
                )
            }
            Self::TakenForRobot { body, share, limit } => {
                let [share, limit] = [share, limit].map(|part| 100.0 * part);
                format!(
                    "{share:.1} % of the surface of the {body} lies where points were taken for the robot that are \
                     farther from it than noise tells, beside others that were not (allowed: {limit:.1} %):"
                )
            }
            Self::RobotElsewhere { body, share } => format!(
                "the camera of the {body} looked past {:.0} % of the surface of the robot, or of a link, where that is said \
                 to have been:",
                100.0 * share
            ),
            Self::RejectBelowLeast { reject, least } => format!(
                "nothing is near, and {} is the least that the probability of these bodies can be; what reads \
                 as free is below {}:",
                rounded(least),
                rounded(reject)
            ),
            Self::HalfTurn { pose } => format!(
                "from pose {} to the next it turns by half a turn, and rounding decides which way round:",
                pose + 1
            ),
        }
    }

    /// What to do, or what to ask oneself.
    fn remedy(&self) -> &'static str {
        match self {
            Self::NoSurface { .. } => "check the file",
            Self::Missing { .. } => {
                "give the organised cloud, or drop rows that stand for empty space"
            }
            Self::Units { .. } => "is one of them in another unit than metres?",
            Self::FarAway { .. } => {
                "check the pose, its direction and its unit (metres), or the units of the files"
            }
            Self::Sparse { .. } => "is a file in millimetres?",
            Self::Clumps { .. } => "put fewer scans together, or keep one point of each clump",
            Self::Noise { .. } => "give the sensor's noise in metres",
            Self::NoiseOverstated { .. } => "give the sensor's noise, in metres",
            Self::Rounded { .. } => "keep them in double precision, or about an origin nearby",
            Self::SensorPose { .. } => {
                "it looks along z of the file; if the points are in another frame, say where it stood \
                 (`sensor_pose`)"
            }
            Self::SensorTurn { .. } => {
                "it counts as looking along z of the file; leave the turn out, or correct it \
                 (`sensor_pose`)"
            }
            Self::SensorRange { .. } => "another sensor, or another unit?",
            Self::SensorLayout { .. } => "kinect, stereo or tof?",
            Self::NoImage { .. } => {
                "give the organised cloud; in this one flying pixels stay, unless `outliers` drops them"
            }
            Self::ImagePlace { .. } => {
                "say where it stood in their frame (`sensor_pose`), and leave out rows and columns \
                 alike; without the layout what it did not see counts as empty"
            }
            Self::SelfFilter { .. } => {
                "check its pose, its joints, its unit and the padding (metres)"
            }
            Self::NoRobot { .. } => {
                "if the sensor saw it, its base, its joints or a unit are wrong"
            }
            Self::TakenForRobot { .. } => {
                "look again from where the robot is farther from it, or make the padding smaller"
            }
            Self::RobotElsewhere { .. } => "check its base and its joints at that time",
            Self::Padding { .. } => "check its pose, its joints and the padding (metres)",
            Self::OutsideScene { .. } => "is the pose object to scene, in metres?",
            Self::Exchanged { .. } => {
                "are the two exchanged? The scene comes first, and the pose leads from the object into it. \
                 Or is one in another unit than metres?"
            }
            // Then the object is the image.
            Self::Unseen { body: Which::A, .. } => {
                "look from elsewhere, or raise `max_unseen`; a scan of the object alone is given without rows and columns"
            }
            Self::Unseen { .. } | Self::CloseBehind { .. } => {
                "look from elsewhere, or raise `max_unseen`"
            }
            Self::RejectBelowLeast { .. } => "raise `reject`",
            Self::HalfTurn { .. } => "give a pose between them",
        }
    }
}

/// What so many percent of the points, or the like, of a body do.
fn part((percent, what, body): (f64, &str, Which), does: &str) -> String {
    format!("{percent:.0} % of the {what} of the {body} {does}")
}

/// Rounded up, so that what is above the share allowed is not told as if it were not; the last
/// digit of a product is no share (7 % of 0.07, not 8).
fn percent_from(share: f64) -> f64 {
    (100.0 * share - 1e-9).max(0.0).ceil()
}

/// A length with as many digits as help.
pub(crate) fn length(metres: f64) -> String {
    match metres {
        m if m > 0.0 && m < 0.01 => format!("{:.2e} m", m),
        m if m < 1.0 => format!("{:.3} m", m),
        m if m < 100.0 => format!("{:.1} m", m),
        m if m < 1e6 => format!("{:.0} m", m),
        m => format!("{m:.1e} m"),
    }
}
