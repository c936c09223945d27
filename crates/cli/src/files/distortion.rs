//! Whether a file of intrinsics says that its lens distorts.

use anyhow::{Result, bail};
use serde_json::{Map, Value};

use super::json::as_written;

/// The name of the list of coefficients of ROS, which does not tell it.
const LIST: &str = "d";
/// Parts of the names of coefficients.
const COEFFICIENTS: [&str; 3] = ["coef", "radial", "tangential"];
/// Parts of the names of lenses whose images are no pinhole's, whatever the coefficients.
const FISHEYES: [&str; 5] = ["fisheye", "equidist", "kannala", "omni", "sphere"];
/// Parts of the names of models that are a pinhole's where all coefficients are zero: OpenCV, ROS, librealsense, Kalibr.
const PINHOLES: [&str; 6] = ["none", "plumb", "rational", "brown", "radtan", "pinhole"];

/// Refuses coefficients that are not zero, and models of fisheyes: pixels would be taken to look where they do not.
pub(super) fn check(fields: &Map<String, Value>) -> Result<()> {
    for (name, value) in fields {
        let told = match (is_of_distortion(name), value.as_str()) {
            (false, Some(model)) => is_fisheye(name, model).then(|| format!("`{model}`")),
            (false, None) => None,
            (true, Some(model)) => (!is_pinhole(model)).then(|| format!("`{model}`")),
            (true, None) => not_zero(value).map(as_written),
        };
        if let Some(told) = told {
            bail!(
                "`{name}` has {told}, a lens that distorts: rectify the image first, and give the intrinsics of \
                 the rectified one without distortion (of a CameraInfo those in P)"
            );
        }
    }
    Ok(())
}

/// `distortion`, `distCoeffs`, `distortion_model` and the like, and coefficients one by one, such as `k1` and `p2`.
fn is_of_distortion(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let is_coefficient = || {
        let number = name.strip_prefix(['k', 'p']);
        number.is_some_and(|number| number.len() == 1 && number.parse::<u8>().is_ok())
    };
    let is_distance = name.contains("distance");
    let has_part = || COEFFICIENTS.iter().any(|part| name.contains(part));
    name == LIST || (name.contains("dist") && !is_distance) || has_part() || is_coefficient()
}

/// `model`, `camera_model`, `projection`, `type` and the like with the name of a fisheye.
fn is_fisheye(name: &str, model: &str) -> bool {
    let [name, model] = [name, model].map(str::to_ascii_lowercase);
    ["model", "projection", "type"].iter().any(|part| name.contains(part))
        && FISHEYES.iter().any(|known| model.contains(known))
}

fn is_pinhole(model: &str) -> bool {
    let model = model.to_ascii_lowercase();
    model.is_empty() || PINHOLES.iter().any(|known| model.contains(known))
}

/// What is not zero of a number or a list.
fn not_zero(value: &Value) -> Option<&Value> {
    let list = value.get("data").unwrap_or(value);
    let list = list.as_array().map_or(std::slice::from_ref(list), Vec::as_slice);
    list.iter().find(|one| !one.is_null() && one.as_f64() != Some(0.0))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use serde_json::json;

    use super::*;

    fn told(fields: Value) -> Option<String> {
        check(fields.as_object().unwrap()).err().map(|error| error.to_string())
    }

    /// Only eleven names were known, and later none of coefficients alone: with others a fisheye was taken for a pinhole.
    #[test]
    fn distortion_is_known_by_any_of_its_names() {
        for fields in [
            json!({"D": [0.0, 0.1]}),
            json!({"distortion_coeffs": [0.0, -0.02, 0.0, 0.0]}),
            json!({"distCoeffs": {"rows": 1, "data": [0.1]}}),
            json!({"Distortion": [[0.1]]}),
            json!({"k4": 0.001}),
            json!({"distortion_model": "equidistant", "D": [0, 0, 0, 0]}),
            json!({"coefficients": [0.1, 0.0]}),
            json!({"radial": [0.0, 0.1], "tangential": [0.0, 0.0]}),
            json!({"camera_model": "OPENCV_FISHEYE"}),
            json!({"model": "fisheye"}),
        ] {
            let error = told(fields.clone());
            assert!(error.is_some_and(|error| error.contains("without distortion")), "{fields}");
        }
        for fields in [
            json!({"distortion_model": "plumb_bob", "D": [0, 0, 0, 0, 0]}),
            json!({"model": "distortion.brown_conrady", "coeffs": [0.0, 0.0]}),
            json!({"model": "Intel RealSense D435", "camera_model": "PINHOLE"}),
            json!({"distortion": null, "max_distance": 4.0, "K": [525, 0, 320]}),
        ] {
            assert_eq!(told(fields), None);
        }
    }
}
