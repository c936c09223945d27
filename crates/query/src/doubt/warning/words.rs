//! The sentence of each warning, with its remedy.

use std::fmt;

use super::Warning;

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoSurface { body, points } => write!(
                f,
                "the {body} has {points} distinct points or corners, all on a line: they span no \
                 surface; check the file"
            ),
            Self::Missing { body, share } => write!(
                f,
                "{:.0} % of the rows of the {body} have no return, and without an image layout it is \
                 not known where: give the organised cloud, or drop rows that stand for empty space",
                100.0 * share
            ),
            Self::Units { body, size_m, other_size_m } => write!(
                f,
                "the {body} is {} across and the other body {}: is one of them in another unit than \
                 metres?",
                length(size_m),
                length(other_size_m)
            ),
            Self::FarAway { gap_m, size_m } => write!(
                f,
                "the object is {} away from a scene {} across: check the pose, its direction and its \
                 unit (metres), or the units of the files",
                length(gap_m),
                length(size_m)
            ),
            Self::Sparse { body, spacing_m, other_size_m } => write!(
                f,
                "points of the {body} are {} apart and the other body is {} across: it fits between \
                 them; is a file in millimetres?",
                length(spacing_m),
                length(other_size_m)
            ),
            Self::Clumps { body, across_m, apart_m } => write!(
                f,
                "points of the {body} lie in clumps some {} across and {} from one another, as many scans \
                 of the same rays do: nothing is known between them; put fewer scans together, or keep \
                 one point of each clump",
                length(across_m),
                length(apart_m)
            ),
            Self::Noise { body, std_m, other_size_m } => write!(
                f,
                "the noise of the {body} is {} and the other body {} across: give the sensor's noise \
                 in metres",
                length(std_m),
                length(other_size_m)
            ),
            Self::NoiseOverstated { body, std_m, seen_m } => write!(
                f,
                "the noise stated for the {body} is {} and its points are {} off planes: give the \
                 sensor's noise, in metres",
                length(std_m),
                length(seen_m)
            ),
            Self::Rounded { body, step_m } => write!(
                f,
                "coordinates of the {body} were kept in single precision, and where they are that tells places \
                 no finer than {}: keep them in double precision, or about an origin nearby",
                length(step_m)
            ),
            Self::SensorPose { body, share } => write!(
                f,
                "{:.0} % of the points of the {body} are beside or behind the camera stated for it: \
                 it looks along z of the file; if the points are in another frame, say where it stood \
                 (`sensor_pose`, VIEWPOINT of a PCD)",
                (100.0 * share).ceil()
            ),
            Self::SensorTurn { body, share } => write!(
                f,
                "{:.0} % of the points of the {body} are behind the camera by the turn stated for it, which is \
                 not believed: it counts as looking along z of the file; leave the turn out, or correct it \
                 (`sensor_pose`, VIEWPOINT of a PCD)",
                100.0 * share
            ),
            Self::SensorRange { body, range_m, limit_m } => write!(
                f,
                "points of the {body} are {} away and its sensor sees no farther than {}: another \
                 sensor, or another unit?",
                length(range_m),
                length(limit_m)
            ),
            Self::SensorLayout { body } => write!(
                f,
                "the {body} is laid out as the image of a camera and its sensor is stated as a laser \
                 scanner: kinect or stereo?"
            ),
            Self::NoImage { body } => write!(
                f,
                "the {body} is of a camera and has no image layout: what the camera did not see \
                 counts as empty; give the organised cloud"
            ),
            Self::ImagePlace { body } => write!(
                f,
                "the {body} has rows and columns as an image, which no camera at the place stated for it \
                 has: give the points without the layout, or, if they are in another frame, say where it \
                 stood (`sensor_pose`, VIEWPOINT of a PCD)"
            ),
            Self::SelfFilter { body, share } => write!(
                f,
                "{:.0} % of the points of the {body} were taken for the robot and left out: check its \
                 pose, its joints, its unit and the padding (metres)",
                100.0 * share
            ),
            Self::NoRobot { body } => write!(
                f,
                "no point of the {body} lies on the robot that was to be left out: if the sensor saw it, its \
                 base, its joints or a unit are wrong"
            ),
            Self::Padding { body, share } => write!(
                f,
                "{:.0} % of the points of the {body} that were left out as the robot's are farther from it \
                 than their noise tells, and may be of what is beside it: check its pose, its joints and the \
                 padding (metres)",
                100.0 * share
            ),
            Self::OutsideScene { gap_m, size_m } => write!(
                f,
                "the object is outside of the scene, {} from its box of {}: is the pose object to \
                 scene, in metres?",
                length(gap_m),
                length(size_m)
            ),
            Self::Exchanged { size_m, other_size_m } => write!(
                f,
                "the object is {} across and the scene {}: are the two exchanged? The scene comes first, and \
                 the pose leads from the object into it. Or is one in another unit than metres?",
                length(size_m),
                length(other_size_m)
            ),
            Self::Unseen { body, share, limit } => write!(
                f,
                "{:.0} % of the surface of the {body} lies where the sensor saw nothing (allowed: \
                 {:.0} %): look from elsewhere, or raise `max_unseen`",
                (100.0 * share).ceil(),
                100.0 * limit
            ),
        }
    }
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
