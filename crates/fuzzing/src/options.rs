//! Options of the command line: any text gives a pose, a sensor, a camera or an error that says something.

use cloudtouch::geom::Pose;
use cloudtouch::noise::SensorModel;
use cloudtouch_cli::files::{intrinsics, pose};
use cloudtouch_cli::intrinsics::Intrinsics;
use cloudtouch_cli::numbers::{self, Rigid, Triple, Turn};

/// The longest message beside what it quotes, which is no more than a few times the text itself.
const LONGEST_BESIDE: usize = 500;

/// Bytes as the text of a pose, a turn, a place, a sensor and a camera.
///
/// # Panics
/// When what is taken is not finite or not rigid, or an error says nothing or quotes far too much.
pub fn options(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    check(text, pose::parse(text).map_err(|error| format!("{error:#}")), is_rigid);
    check(text, numbers::rigid(text), |Rigid(pose)| is_rigid(pose));
    check(text, numbers::triple(text), |Triple(numbers)| numbers.iter().all(|v| v.is_finite()));
    for turn in [numbers::turn_in_radians, numbers::turn_in_degrees, numbers::quaternion] {
        check(text, turn(text), |Turn(turn)| (turn.norm() - 1.0).abs() < 1e-9);
    }
    check(text, numbers::share(text), |share| (0.0..=1.0).contains(share));
    check(text, Intrinsics::parse(text), |_| true);
    let camera = intrinsics::parse(bytes, "7").map_err(|error| format!("{error:#}"));
    check(text, camera, |file| file.camera.validate().is_ok());
    let sensor = text.parse::<SensorModel>().map_err(|error| error.to_string());
    check(text, sensor, |sensor| {
        sensor.validate().is_ok() && sensor.to_string().parse() == Ok(*sensor)
    });
}

fn check<T>(text: &str, parsed: Result<T, String>, is_sound: impl Fn(&T) -> bool) {
    match parsed {
        Ok(value) => assert!(is_sound(&value), "{text}"),
        Err(message) => {
            assert!(!message.trim().is_empty(), "an error without a message");
            let most = LONGEST_BESIDE + 4 * text.len();
            assert!(message.len() < most, "{} bytes of message", message.len());
        }
    }
}

fn is_rigid(pose: &Pose) -> bool {
    pose.non_finite_entry().is_none() && (pose.rotation().norm() - 1.0).abs() < 1e-9
}
