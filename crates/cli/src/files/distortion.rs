//! Whether a file of intrinsics says that its lens distorts.

use anyhow::{Result, bail};
use serde_json::{Map, Value};

use super::json::as_written;

/// Names of lists of coefficients that do not tell it: ROS, librealsense.
const LISTS: [&str; 2] = ["d", "coeffs"];
/// Parts of the names of models that are a pinhole's where all coefficients are zero: OpenCV, ROS, librealsense, Kalibr.
const PINHOLES: [&str; 6] = ["none", "plumb", "rational", "brown", "radtan", "pinhole"];

/// Refuses coefficients that are not zero, and models of fisheyes: pixels would be taken to look where they do not.
pub(super) fn check(fields: &Map<String, Value>) -> Result<()> {
    for (name, value) in fields {
        let told = match (is_of_distortion(name), value.as_str()) {
            (false, _) => None,
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
    LISTS.contains(&&*name) || (name.contains("dist") && !is_distance) || is_coefficient()
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

    /// Only eleven names were known: with others a fisheye was taken for a pinhole.
    #[test]
    fn distortion_is_known_by_any_of_its_names() {
        for fields in [
            json!({"D": [0.0, 0.1]}),
            json!({"distortion_coeffs": [0.0, -0.02, 0.0, 0.0]}),
            json!({"distCoeffs": {"rows": 1, "data": [0.1]}}),
            json!({"Distortion": [[0.1]]}),
            json!({"k4": 0.001}),
            json!({"distortion_model": "equidistant", "D": [0, 0, 0, 0]}),
        ] {
            let error = told(fields.clone());
            assert!(error.is_some_and(|error| error.contains("without distortion")), "{fields}");
        }
        for fields in [
            json!({"distortion_model": "plumb_bob", "D": [0, 0, 0, 0, 0]}),
            json!({"model": "distortion.brown_conrady", "coeffs": [0.0, 0.0]}),
            json!({"distortion": null, "max_distance": 4.0, "K": [525, 0, 320]}),
        ] {
            assert_eq!(told(fields), None);
        }
    }
}
