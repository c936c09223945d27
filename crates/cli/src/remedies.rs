//! Which option of this tool does what the messages of the libraries ask for: they know no options.

use std::collections::BTreeMap;

use cloudtouch::{PrepareError, Undecided, Warning};
use cloudtouch_io::recording::RecordingFault;
use cloudtouch_io::{Fault, LengthUnit, ReadError};
use cloudtouch_robot::{RobotError, RobotFault};
use serde_json::Value;

const SENSOR_POSE: &str = "--sensor-pose, in a scene file `sensor_pose`, in a PCD VIEWPOINT";

/// A warning with the option that mends it.
pub(crate) fn warning(warning: &Warning) -> String {
    with(warning.to_string(), of_warning(warning))
}

/// Why there is no decision, and which option tells what is missing.
pub(crate) fn undecided(by: Undecided) -> String {
    with(by.to_string(), (by == Undecided::Enclosed).then_some(SENSOR_POSE))
}

/// The same where `--sensor-pose` may have been given, which need not be said twice.
pub(crate) fn undecided_from(by: Undecided, sensor_is_placed: bool) -> String {
    if by == Undecided::Enclosed && sensor_is_placed {
        return "one surface is all around the other, and where the sensor stood does not tell whether it is \
                hollow or solid: look from elsewhere, or close the mesh"
            .to_owned();
    }
    undecided(by)
}

/// An error with its causes, and the option that mends it.
pub(crate) fn error(error: &anyhow::Error) -> String {
    let option = error.chain().find_map(|cause| {
        if let Some(RobotError { fault, .. }) = cause.downcast_ref() {
            of_robot(fault)
        } else if let Some(PrepareError::NoiseBeyondSize { range, .. }) = cause.downcast_ref() {
            let place = if range.is_some() { ", --sensor-pose" } else { "" };
            Some(format!("--cloud-unit mm, --depth-scale{place}"))
        } else if let Some(PrepareError::CoordinateRange { index, .. }) = cause.downcast_ref() {
            Some(format!("counted from 1, as rows are: {}", index + 1))
        } else {
            of_file(cause.downcast_ref()?)
        }
    });
    with(format!("{error:#}"), option.as_deref())
}

/// A line of JSON with the options of these warnings in its words. Reports write their warnings
/// themselves, and made of a value the line would have its keys in another order.
pub(crate) fn in_json<'a>(line: String, warnings: impl IntoIterator<Item = &'a Warning>) -> String {
    const WORDS: &str = "\"words\":";
    let quoted = |text: String| Value::from(text).to_string();
    let with_option = warnings.into_iter().filter(|of| of_warning(of).is_some());
    let told: BTreeMap<String, String> =
        with_option.map(|of| (quoted(of.to_string()), quoted(warning(of)))).collect();
    if told.is_empty() {
        return line;
    }
    // In one pass: a scene may have as many warnings as pairs. Within a string its quotes would be escaped.
    let (mut text, mut rest) = (String::with_capacity(line.len()), line.as_str());
    while let Some(at) = rest.find(WORDS) {
        let (before, after) = rest.split_at(at + WORDS.len());
        let (words, following) = after.split_at(end_of_string(after));
        text += before;
        text += told.get(words).map_or(words, String::as_str);
        rest = following;
    }
    text + rest
}

/// Where the string ends that JSON begins with.
fn end_of_string(json: &str) -> usize {
    let mut is_escaped = true;
    let is_end = |byte: u8| {
        let ends = byte == b'"' && !is_escaped;
        is_escaped = byte == b'\\' && !is_escaped;
        ends
    };
    json.bytes().position(is_end).map_or(0, |at| at + 1)
}

fn with(message: String, option: Option<&str>) -> String {
    option.map_or(message.clone(), |option| format!("{message} ({option})"))
}

pub(crate) fn of_warning(warning: &Warning) -> Option<&'static str> {
    Some(match warning {
        Warning::Units { .. } => {
            "--unit mm for meshes, --cloud-unit mm for clouds, --depth-scale for depth images"
        }
        Warning::Sparse { .. } => "--cloud-unit mm, --unit mm, --depth-scale",
        Warning::SensorPose { .. } | Warning::SensorTurn { .. } | Warning::ImagePlace { .. } => {
            SENSOR_POSE
        }
        Warning::SensorRange { .. } => "--sensor auto, --cloud-unit, --depth-scale",
        Warning::SensorLayout { .. } => "--sensor auto",
        Warning::NoImage { .. } => "--outliers 8,3",
        Warning::TakenForRobot { .. } => "--padding, in query --robot-padding",
        Warning::Unseen { .. } | Warning::CloseBehind { .. } => "--max-unseen",
        Warning::RejectBelowLeast { .. } => "--reject",
        _ => return None,
    })
}

fn of_file(error: &ReadError) -> Option<String> {
    match error {
        ReadError::TooLarge { .. } => Some("--max-bytes".to_owned()),
        ReadError::NoRecordings { .. } => {
            Some("cargo install --locked --path crates/cli --features mcap".to_owned())
        }
        ReadError::Format { problem, .. } => match problem.fault {
            // Such as `points` or `declared points`.
            Fault::TooMany { what, .. } => Some(format!("--max-{}", what.rsplit(' ').next()?)),
            Fault::ColumnUnit { ref unit, .. } => {
                let unit = unit.parse::<LengthUnit>().ok()?;
                Some(format!("--cloud-unit {unit}"))
            }
            _ => None,
        },
        ReadError::Extension { found, .. } => match found.as_str() {
            "json" => Some("cloudtouch scene FILE, cloudtouch batch FILE".to_owned()),
            "urdf" => Some("cloudtouch robot SCAN URDF".to_owned()),
            _ => None,
        },
        ReadError::Recording { problem, .. } => match **problem {
            RecordingFault::TooLarge { .. } => Some("--max-bytes".to_owned()),
            _ => None,
        },
        _ => None,
    }
}

fn of_robot(fault: &RobotFault) -> Option<String> {
    match fault {
        RobotFault::UnknownPackage { package, .. } => Some(format!("--package {package}=FOLDER")),
        RobotFault::Mesh { error, .. } => of_file(error),
        _ => None,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]
mod tests {
    use anyhow::Context as _;
    use cloudtouch::Which;

    use super::*;

    #[test]
    fn what_a_library_says_is_told_with_the_option_that_does_it() {
        let link = || "arm".to_owned();
        let large = || ReadError::TooLarge { path: "a.stl".into(), limit: 9 };
        let of_robot = |fault| RobotError { file: "arm.urdf".into(), fault: Box::new(fault) };
        let (uri, package) = ("package://mine/a.stl".to_owned(), "mine".to_owned());
        let unknown = RobotFault::UnknownPackage { link: link(), uri, package };
        let other = |name: &str| cloudtouch_io::check_extension(name).unwrap_err();
        let millimetres = cloudtouch_io::xyz::parse(b"x (mm),y (mm),z (mm)").unwrap_err();
        let millimetres = ReadError::Format { path: "a.csv".into(), problem: millimetres.into() };
        let beyond = PrepareError::CoordinateRange { index: 3, value: 1e20 };
        let noise = PrepareError::NoiseBeyondSize { std: 5.0, size: 1.0, range: None };
        for (told, option) in [
            (anyhow::Error::from(large()), " (--max-bytes)"),
            (of_robot(RobotFault::Mesh { link: link(), error: large() }).into(), " (--max-bytes)"),
            (of_robot(unknown).into(), "`packages` (--package mine=FOLDER)"),
            (noise.into(), " (--cloud-unit mm, --depth-scale)"),
            (
                beyond.into(),
                "point 3 has the coordinate 1e20, beyond 1e10 m: check the unit, or remove the point \
                (counted from 1, as rows are: 4)",
            ),
            (other("cases.json").into(), " (cloudtouch scene FILE, cloudtouch batch FILE)"),
            (other("arm.urdf").into(), " (cloudtouch robot SCAN URDF)"),
            (other("scan.las").into(), " with CloudCompare or PDAL"),
            (millimetres.into(), " (--cloud-unit mm)"),
            (anyhow::anyhow!("a slip"), "a slip"),
        ] {
            let told = error(&Err::<(), _>(told).context("scan.pcd").unwrap_err());
            assert!(told.starts_with("scan.pcd: ") && told.ends_with(option), "{told}");
        }
    }

    /// The whole line was looked through for each of them: minutes for a scene of many doubtful pairs.
    #[test]
    fn many_warnings_in_a_line_of_json_are_told_in_one_pass() {
        let unseen = |k: u32| Warning::Unseen { body: Which::B, share: f64::from(k), limit: 0.05 };
        let warnings: Vec<Warning> = (0..40_000).map(unseen).collect();
        let line = serde_json::to_string(&warnings).unwrap();
        let told = in_json(line, &warnings);
        assert_eq!(told.matches("(--max-unseen)\"").count(), warnings.len());
    }

    /// Words with quotes and backslashes end where they do.
    #[test]
    fn a_string_of_json_ends_at_the_quote_that_is_not_escaped() {
        for text in ["", "a", "\\", "\"", "a\\\"b\\\\", "\u{1}é"] {
            let json = Value::from(text).to_string();
            assert_eq!(end_of_string(&(json.clone() + ",\"b\":1")), json.len(), "{json}");
        }
    }

    #[test]
    fn warnings_in_a_line_of_json_have_their_options_once() {
        let unseen = Warning::Unseen { body: Which::B, share: 0.5, limit: 0.05 };
        let far = Warning::FarAway { gap_m: 9.0, size_m: 1.0 };
        let line = serde_json::to_string(&[unseen, far, unseen]).unwrap();
        let told = in_json(line.clone(), &[unseen, far, unseen]);
        assert_eq!(told.matches("raise `max_unseen` (--max-unseen)\"").count(), 2, "{told}");
        assert_eq!(told.replace(" (--max-unseen)", ""), line);
    }
}
