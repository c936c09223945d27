//! Numbers as the options spell them: lengths, angles, poses and fractions.

use cloudtouch::LARGEST_COORDINATE;
use cloudtouch::geom::message::number;
use cloudtouch::geom::{Pose, Vector3};
use nalgebra::UnitQuaternion;

/// Three finite numbers. A type of its own, since clap takes a bare list for repeated values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triple(pub [f64; 3]);

/// A turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn(pub UnitQuaternion<f64>);

/// A rigid motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rigid(pub Pose);

/// Radians beyond a whole turn are rather degrees.
const WHOLE_TURN: f64 = std::f64::consts::TAU;

/// `X,Y,Z`.
///
/// # Errors
/// When there are not three numbers, or one of them is not finite.
pub fn triple(text: &str) -> Result<Triple, String> {
    Ok(Triple(numbers(text, "three, as in 0.4,0,-1.2")?))
}

/// `X,Y,Z` in metres.
///
/// # Errors
/// As [`triple`], and when one of them is beyond 1e10 m.
pub fn place(text: &str) -> Result<Triple, String> {
    let Triple(at) = triple(text)?;
    within_reach(&at)?;
    Ok(Triple(at))
}

fn within_reach(lengths: &[f64]) -> Result<(), String> {
    match lengths.iter().find(|length| length.abs() > LARGEST_COORDINATE) {
        Some(length) => {
            let length = number(*length);
            Err(format!("{length} m is beyond {LARGEST_COORDINATE:e} m: give metres"))
        }
        None => Ok(()),
    }
}

/// Standard deviations of a pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseStd(pub [f64; 6]);

/// `X,Y,Z,R,P,Y`: standard deviations along the axes of the object, m, and about them, rad.
///
/// # Errors
/// When there are not six finite numbers, one is negative, a length is beyond 1e10 m, or an angle beyond
/// half a turn.
pub fn pose_std(text: &str) -> Result<PoseStd, String> {
    let stds: [f64; 6] =
        numbers(text, "six, three in m and three in rad, as in 0.005,0.005,0.005,0.01,0.01,0.01")?;
    if let Some(std) = stds.iter().find(|std| **std < 0.0) {
        return Err(format!("{std} is negative: a standard deviation is 0 or more"));
    }
    within_reach(&stds[..3])?;
    match stds[3..].iter().find(|angle| **angle > 0.5 * WHOLE_TURN) {
        Some(angle) => Err(format!("{angle} rad is more than half a turn: is it in degrees?")),
        None => Ok(PoseStd(stds)),
    }
}

/// `R,P,Y` in radians: roll, pitch and yaw, in this order about fixed axes.
///
/// # Errors
/// As [`triple`], and when an angle is beyond a whole turn.
pub fn turn_in_radians(text: &str) -> Result<Turn, String> {
    let Triple(angles) = triple(text)?;
    match angles.iter().find(|angle| angle.abs() > WHOLE_TURN + 1e-9) {
        Some(angle) => Err(format!(
            "{angle} rad is more than a whole turn: is it in degrees? Then give --rotate-deg {text}"
        )),
        None => Ok(from_rpy(angles)),
    }
}

/// `R,P,Y` in degrees: roll, pitch and yaw, in this order about fixed axes.
///
/// # Errors
/// As [`triple`].
pub fn turn_in_degrees(text: &str) -> Result<Turn, String> {
    let Triple(angles) = triple(text)?;
    Ok(from_rpy(angles.map(f64::to_radians)))
}

/// `X,Y,Z,W`, the order of ROS.
///
/// # Errors
/// When there are not four finite numbers of length one, up to the rounding of a text file.
pub fn quaternion(text: &str) -> Result<Turn, String> {
    let [x, y, z, w] = numbers(text, "four, x,y,z,w, as in 0,0,0.7071,0.7071")?;
    let pose = Pose::try_from_quaternion(Vector3::zeros(), [w, x, y, z]);
    pose.map(|pose| Turn(*pose.rotation())).map_err(|error| error.to_string())
}

/// `X,Y,Z` in metres, or `X,Y,Z,QX,QY,QZ,QW` with a quaternion in the order of ROS.
///
/// # Errors
/// When there are neither three nor seven finite numbers, a place is beyond 1e10 m, or the quaternion is not
/// of length one.
pub fn rigid(text: &str) -> Result<Rigid, String> {
    let Some((at, turn)) =
        text.match_indices(',').nth(2).map(|(i, _)| (&text[..i], &text[i + 1..]))
    else {
        let Triple(at) = place(text)?;
        return Ok(Rigid(Pose::from_translation(at.into())));
    };
    let count = text.split(',').count();
    if count != 7 && separated(text).is_none() {
        return Err(format!("{count} numbers are given: write three, or seven with x,y,z,w last"));
    }
    let (Triple(at), Turn(turn)) = (place(at)?, quaternion(turn)?);
    Ok(Rigid(Pose::from_translation_rotation(at.into(), turn)))
}

/// `FX,FY,CX,CY`, pixels.
///
/// # Errors
/// When there are not four finite numbers.
pub fn intrinsics(text: &str) -> Result<[f64; 4], String> {
    numbers(text, "four, fx,fy,cx,cy, as in 525,525,319.5,239.5")
}

/// A finite number.
///
/// # Errors
/// When it is none.
pub fn finite(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(format!("`{text}` is not finite")),
        Err(_) => Err(format!("`{text}` is not a number")),
    }
}

/// A share from 0 to 1.
///
/// # Errors
/// When it is none.
pub fn share(text: &str) -> Result<f64, String> {
    let share = finite(text)?;
    if (0.0..=1.0).contains(&share) { Ok(share) } else { Err("give 0 to 1".to_owned()) }
}

fn numbers<const N: usize>(text: &str, form: &str) -> Result<[f64; N], String> {
    if let Some(separated) = separated(text) {
        return Err(format!("numbers are separated by commas: write {separated}"));
    }
    let told = |why| format!("{why}: write {form}");
    let numbers =
        text.split(',').map(finite).collect::<Result<Vec<f64>, String>>().map_err(told)?;
    let count = numbers.len();
    numbers.try_into().map_err(|_| format!("{count} numbers are given: write {form}"))
}

/// The same numbers with commas, where spaces stand in the place of some.
fn separated(text: &str) -> Option<String> {
    let lacks_some = text.split(',').any(|part| part.split_whitespace().nth(1).is_some());
    let parts =
        || text.split(|c: char| c == ',' || c.is_whitespace()).filter(|part| !part.is_empty());
    let are_numbers = parts().all(|part| finite(part).is_ok());
    (lacks_some && are_numbers).then(|| parts().collect::<Vec<_>>().join(","))
}

fn from_rpy(angles: [f64; 3]) -> Turn {
    Turn(*Pose::from_translation_rpy(Vector3::zeros(), angles).rotation())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn degrees_radians_and_quaternions_say_the_same() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let wanted = turn_in_degrees("0,90,0").unwrap();
        let others = [
            turn_in_radians("0,1.5707963267948966,0").unwrap(),
            quaternion(&format!("0,{half},0,{half}")).unwrap(),
        ];
        for Turn(other) in others {
            assert!(wanted.0.angle_to(&other) < 1e-12);
        }
        assert_eq!(
            rigid("1,2,3").unwrap(),
            Rigid(Pose::from_translation(Vector3::new(1.0, 2.0, 3.0)))
        );
        let Rigid(turned) = rigid(&format!("1,2,3,0,{half},0,{half}")).unwrap();
        assert!(turned.rotation().angle_to(&wanted.0) < 1e-12);
    }

    #[test]
    fn ninety_radians_were_taken_for_an_angle() {
        let error = turn_in_radians("0,90,0").unwrap_err();
        assert!(error.contains("90 rad") && error.contains("--rotate-deg 0,90,0"), "{error}");
        assert!(turn_in_radians("0,6.28318530718,0").is_ok());
    }

    #[test]
    fn messages_name_what_was_found_and_what_to_write() {
        for (result, part) in [
            (triple("1,2").map(|_| ()), "2 numbers are given"),
            (triple("1,2,nan").map(|_| ()), "`nan` is not finite"),
            (triple("0.1 0 0.7").map(|_| ()), "write 0.1,0,0.7"),
            (rigid("1, 2 3 0 0 0 1").map(|_| ()), "write 1,2,3,0,0,0,1"),
            (triple("a man").map(|_| ()), "`a man` is not a number: write three, as in"),
            (pose_std("1,1,1,1,1,x").map(|_| ()), "`x` is not a number: write six, three in m"),
            (pose_std("0.1,0.1,0.1").map(|_| ()), "3 numbers are given: write six, three in m and"),
            (quaternion("0,0,0").map(|_| ()), "write four"),
            (quaternion("0,0,0,2").map(|_| ()), "length"),
            (rigid("1,2,3,4").map(|_| ()), "4 numbers are given: write three, or seven"),
            (share("5").map(|_| ()), "0 to 1"),
        ] {
            let error = result.unwrap_err();
            assert!(error.contains(part), "{error}");
        }
    }
}
