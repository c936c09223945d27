//! The text form of a sensor, such as `lidar:0.02,0.003`.

use std::fmt;
use std::str::FromStr;

use cloudtouch_geom::message::number;

use crate::error::NoiseError;
use crate::sensor::model::SensorModel;

impl FromStr for SensorModel {
    type Err = NoiseError;

    /// Reads `exact`, `iso:STD`, `axes:SX,SY,SZ`, `stereo:BASELINE,FOCAL_PX,DISPARITY_STD`,
    /// `kinect`, `tof:STD,PER_METRE`, `lidar:RANGE_STD,BEAM_RAD`, `grid:RESOLUTION` or `per-point`, in
    /// metres, pixels and radians.
    fn from_str(spec: &str) -> Result<Self, NoiseError> {
        let (name, values) = match spec.trim().split_once(':') {
            Some((name, values)) => (name, Some(values)),
            None => (spec.trim(), None),
        };
        let model = match name {
            "exact" => {
                let [] = numbers(spec, values, "exact")?;
                Self::Exact
            }
            "iso" => {
                let [std] = numbers(spec, values, "iso:STD")?;
                Self::Isotropic { std }
            }
            "axes" => Self::Axes { stds: numbers(spec, values, "axes:SX,SY,SZ")? },
            "stereo" => {
                let [baseline, focal_px, disparity_std] = numbers(spec, values, STEREO)?;
                if let Some(problem) = slip(baseline, focal_px) {
                    let spec = spec.to_owned();
                    return Err(NoiseError::SensorSyntax { spec, form: STEREO, problem });
                }
                Self::Stereo { baseline, focal_px, disparity_std }
            }
            "kinect" => {
                let [] = numbers(spec, values, "kinect")?;
                Self::Kinect
            }
            "tof" => {
                let [std, per_metre] = numbers(spec, values, "tof:STD,PER_METRE")?;
                Self::TimeOfFlight { std, per_metre }
            }
            "lidar" => {
                let [range_std, beam_rad] = numbers(spec, values, LIDAR)?;
                if let Some(problem) = slip_of_beam(beam_rad) {
                    let spec = spec.to_owned();
                    return Err(NoiseError::SensorSyntax { spec, form: LIDAR, problem });
                }
                Self::Lidar { range_std, beam_rad }
            }
            "grid" => {
                let [resolution] = numbers(spec, values, "grid:RESOLUTION")?;
                Self::Grid { resolution }
            }
            "per-point" => {
                let [] = numbers(spec, values, "per-point")?;
                Self::PerPoint
            }
            _ => return Err(NoiseError::UnknownSensor { spec: spec.to_owned() }),
        };
        model.validate()?;
        Ok(model)
    }
}

impl fmt::Display for SensorModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact => write!(f, "exact"),
            Self::Isotropic { std } => write!(f, "iso:{}", listed([*std])),
            Self::Axes { stds } => write!(f, "axes:{}", listed(*stds)),
            Self::Stereo { baseline, focal_px, disparity_std } => {
                write!(f, "stereo:{}", listed([*baseline, *focal_px, *disparity_std]))
            }
            Self::Kinect => write!(f, "kinect"),
            Self::TimeOfFlight { std, per_metre } => {
                write!(f, "tof:{}", listed([*std, *per_metre]))
            }
            Self::Lidar { range_std, beam_rad } => {
                write!(f, "lidar:{}", listed([*range_std, *beam_rad]))
            }
            Self::Grid { resolution } => write!(f, "grid:{}", listed([*resolution])),
            Self::PerPoint => write!(f, "per-point"),
        }
    }
}

/// Numbers as they are read back, each in few digits.
fn listed<const N: usize>(values: [f64; N]) -> String {
    values.map(number).join(",")
}

const STEREO: &str = "stereo:BASELINE,FOCAL_PX,DISPARITY_STD";
const LIDAR: &str = "lidar:RANGE_STD,BEAM_RAD";

/// What cannot be meant of a stereo camera: it would be a thousand times as sharp, or as blurred, as it is.
fn slip(baseline: f64, focal_px: f64) -> Option<String> {
    const WIDEST: f64 = 5.0;
    const SHORTEST_PX: f64 = 20.0;
    if baseline > WIDEST {
        Some(format!("a baseline of {baseline} m is wider than {WIDEST} m: is it in millimetres?"))
    } else if focal_px > 0.0 && focal_px < SHORTEST_PX {
        Some(format!(
            "a focal length of {focal_px} pixels: is it in millimetres? Divide by the size of a pixel"
        ))
    } else {
        None
    }
}

/// What cannot be meant of a laser scanner: beams are milliradians wide, and those of the simplest rangefinders half a
/// radian.
fn slip_of_beam(beam_rad: f64) -> Option<String> {
    const WIDEST_RAD: f64 = 0.6;
    (beam_rad > WIDEST_RAD && beam_rad.is_finite()).then(|| {
        format!(
            "a beam of {} rad is wider than {WIDEST_RAD} rad: is it in milliradians or degrees?",
            number(beam_rad)
        )
    })
}

/// The `N` comma-separated numbers after the colon; no colon at all when `N` is zero.
fn numbers<const N: usize>(
    spec: &str,
    values: Option<&str>,
    form: &'static str,
) -> Result<[f64; N], NoiseError> {
    let problem = |problem| NoiseError::SensorSyntax { spec: spec.to_owned(), form, problem };
    let parts: Vec<&str> = values.map(|v| v.split(',').collect()).unwrap_or_default();
    if parts.len() != N {
        return Err(problem(format!("{} values are needed, {} are given", N, parts.len())));
    }
    let mut numbers = [0.0; N];
    for (number, part) in numbers.iter_mut().zip(parts) {
        let part = part.trim();
        // `lidar:0,02` would be 0 and 2.
        if part.strip_prefix('0').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
        {
            return Err(problem(format!(
                "`{part}` begins with a zero: decimals have a point, as in 0.02"
            )));
        }
        *number = part.parse().map_err(|_| problem(format!("`{part}` is not a number")))?;
    }
    Ok(numbers)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn any_sensor() -> impl Strategy<Value = SensorModel> {
        let small = || 0.0..2.0_f64;
        let positive = || 1e-6..1e3_f64;
        prop_oneof![
            Just(SensorModel::Exact),
            Just(SensorModel::Kinect),
            Just(SensorModel::PerPoint),
            small().prop_map(|std| SensorModel::Isotropic { std }),
            [small(), small(), small()].prop_map(|stds| SensorModel::Axes { stds }),
            (1e-6..5.0_f64, 20.0..1e4_f64, small()).prop_map(
                |(baseline, focal_px, disparity_std)| {
                    SensorModel::Stereo { baseline, focal_px, disparity_std }
                }
            ),
            (small(), 0.0..0.6_f64)
                .prop_map(|(range_std, beam_rad)| SensorModel::Lidar { range_std, beam_rad }),
            (small(), small())
                .prop_map(|(std, per_metre)| SensorModel::TimeOfFlight { std, per_metre }),
            positive().prop_map(|resolution| SensorModel::Grid { resolution }),
        ]
    }

    proptest! {
        #[test]
        fn text_reads_back_as_the_same_sensor(sensor in any_sensor()) {
            prop_assert_eq!(sensor.to_string().parse::<SensorModel>(), Ok(sensor));
        }

        #[test]
        fn no_text_panics(spec in "[a-z:,.0-9 -]{0,20}") {
            let _ = spec.parse::<SensorModel>();
        }
    }

    #[test]
    fn tiny_numbers_were_spelled_with_hundreds_of_zeros() {
        assert_eq!(SensorModel::Grid { resolution: 1e-300 }.to_string(), "grid:1e-300");
        assert_eq!(SensorModel::Isotropic { std: 0.005 }.to_string(), "iso:0.005");
    }

    #[test]
    fn documented_forms_are_read() {
        let read = |spec: &str| spec.parse::<SensorModel>();
        assert_eq!(read("iso:0.005"), Ok(SensorModel::Isotropic { std: 0.005 }));
        assert_eq!(read(" axes:0.3, 0.3,0.15 "), Ok(SensorModel::Axes { stds: [0.3, 0.3, 0.15] }));
        assert_eq!(
            read("stereo:0.09,570,0.2"),
            Ok(SensorModel::Stereo { baseline: 0.09, focal_px: 570.0, disparity_std: 0.2 })
        );
        assert_eq!(
            read("lidar:0.02,0.003"),
            Ok(SensorModel::Lidar { range_std: 0.02, beam_rad: 0.003 })
        );
    }

    #[test]
    fn errors_name_the_value_and_the_right_form() {
        let message = |spec: &str| spec.parse::<SensorModel>().unwrap_err().to_string();
        for (spec, parts) in [
            ("sonar", &["`sonar`", "lidar:RANGE_STD,BEAM_RAD"][..]),
            ("", &["``", "iso:STD"]),
            ("iso", &["`iso`", "iso:STD", "1 values are needed, 0"]),
            ("iso:5mm", &["`5mm` is not a number", "iso:STD"]),
            ("kinect:1", &["`kinect:1`", "0 values are needed, 1"]),
            ("lidar:0.1,0.2,0.3", &["lidar:RANGE_STD,BEAM_RAD", "2 values are needed, 3"]),
            ("tof:0.001", &["tof:STD,PER_METRE", "2 values are needed, 1"]),
            ("tof:0.001,-1", &["a metre adds", "-1", "not negative"]),
            ("iso:-0.1", &["standard deviation", "-0.1", "not negative"]),
            ("axes:0,0,inf", &["along z", "inf", "finite"]),
            // Its square is no number: a point was blamed.
            ("iso:1e300", &["standard deviation", "1e300", "at most 1e10"]),
            ("stereo:0,500,0.1", &["baseline", "is 0", "positive"]),
            // Read as 90 m, a cloud was a thousand times too sharp.
            ("stereo:90,570,0.2", &["90 m", "in millimetres?"]),
            ("stereo:0.09,0.57,0.2", &["0.57 pixels", "in millimetres?"]),
            // Of milliradians a point ten metres away was uncertain by metres across its ray.
            ("lidar:0.02,3", &["a beam of 3 rad", "in milliradians or degrees?"]),
            ("lidar:0.02,inf", &["the beam divergence", "inf", "not negative"]),
            // Decimals with a comma: no noise along the ray, and metres across it.
            ("lidar:0,02", &["`02` begins with a zero", "a point, as in 0.02"]),
            ("tof:0,001", &["`001` begins with a zero", "tof:STD,PER_METRE"]),
            ("grid:NaN", &["resolution", "NaN", "positive"]),
        ] {
            let text = message(spec);
            for part in parts {
                assert!(text.contains(part), "`{spec}` gives: {text}");
            }
        }
    }
}
