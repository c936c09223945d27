//! What a CameraInfo of ROS says beside its matrix: of which image that matrix is.

use anyhow::{Result, ensure};
use serde_json::{Map, Value};

use super::json::as_written;

/// Programs that rectify round: closer numbers are the same, pixels.
const SAME: f64 = 0.01;
/// No entry of a turn is farther from that of none than so: a tenth of a millimetre a metre.
const TURNED: f64 = 1e-4;
/// Where fx, fy, cx and cy are among the twelve numbers of `P`.
const PLACES: [(&str, usize); 4] = [("fx", 0), ("fy", 5), ("cx", 2), ("cy", 6)];
const REMEDY: &str =
    "give those of this very image (--intrinsics FX,FY,CX,CY, or a file without it)";

/// Refuses what makes the matrix one of another image than the depth image: pixels put together, a part that was cut
/// out, or a rectified image with other intrinsics, which are then in `P`.
pub(super) fn check(fields: &Map<String, Value>, intrinsics: [f64; 4]) -> Result<()> {
    for name in ["binning_x", "binning_y"] {
        if let Some(value) = fields.get(name) {
            ensure!(
                value.is_null() || value.as_f64().is_some_and(|pixels| pixels <= 1.0),
                "`{name}` is {}, so the intrinsics are of an image with more pixels: {REMEDY}",
                as_written(value)
            );
        }
    }
    for name in ["x_offset", "y_offset"] {
        if let Some(value) = fields.get("roi").and_then(|part| part.get(name)) {
            ensure!(
                value.is_null() || value.as_f64() == Some(0.0),
                "`roi` has {name} {}, so the intrinsics are of an image of which a part was cut out: {REMEDY}",
                as_written(value)
            );
        }
    }
    for name in ["P", "p"] {
        let Some(rectified) = fields.get(name).and_then(numbers::<12>) else { continue };
        // What drivers write that do not know it.
        if rectified.iter().all(|number| *number == 0.0) {
            continue;
        }
        for ((of, place), stated) in PLACES.into_iter().zip(intrinsics) {
            let found = rectified[place];
            ensure!(
                (found - stated).abs() <= SAME,
                "`{name}` has {of} {found}, and the matrix beside it {stated}: one is of the rectified image, the \
                 other of the image as it was taken; {REMEDY}"
            );
        }
    }
    check_turn(fields)
}

/// Refuses a rectified image that is turned against the one taken: beside a `P`, for elsewhere an `R` is the turn of the
/// camera in the world.
fn check_turn(fields: &Map<String, Value>) -> Result<()> {
    if !fields.contains_key("P") && !fields.contains_key("p") {
        return Ok(());
    }
    for name in ["R", "r"] {
        let Some(turn) = fields.get(name).and_then(numbers::<9>) else { continue };
        if turn == [0.0; 9] {
            continue;
        }
        for (place, found) in turn.into_iter().enumerate() {
            let (row, column) = (place / 3, place % 3);
            let unturned = if row == column { 1.0 } else { 0.0 };
            ensure!(
                (found - unturned).abs() <= TURNED,
                "`{name}` has {found} in row {} and column {}, where no turn has {unturned}: the rectified image looks \
                 elsewhere than the one that was taken; {REMEDY}",
                row + 1,
                column + 1
            );
        }
    }
    Ok(())
}

/// So many numbers, in one list or in rows.
fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let rows = value.as_array()?.iter();
    let rows = rows.map(|row| row.as_array().map_or(std::slice::from_ref(row), Vec::as_slice));
    let numbers: Option<Vec<f64>> = rows.flatten().map(Value::as_f64).collect();
    numbers?.try_into().ok()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use serde_json::json;

    use super::*;

    const K: [f64; 4] = [525.0, 526.0, 319.5, 239.25];

    fn told(fields: Value) -> Option<String> {
        check(fields.as_object().unwrap(), K).err().map(|error| error.to_string())
    }

    /// It was passed over where `P` is as `K`.
    #[test]
    fn a_rectified_image_that_is_turned_is_refused() {
        let [fx, fy, cx, cy] = K;
        let p = [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0];
        let turn = [0.8, 0.0, 0.6, 0.0, 1.0, 0.0, -0.6, 0.0, 0.8];
        for fields in [json!({"R": turn, "P": p}), json!({"r": turn.as_chunks::<3>().0, "p": p})] {
            let error = told(fields).unwrap_or_default();
            for part in ["` has 0.8 in row 1 and column 1", "has 1:", "FX,FY,CX,CY"] {
                assert!(error.contains(part), "{error}");
            }
        }
        let none = [1.0, 1e-5, 0.0, -1e-5, 1.0, 0.0, 0.0, 0.0, 1.0];
        for fields in [
            json!({"R": none, "P": p}),
            json!({"R": vec![0.0; 9], "P": p}),
            json!({"R": "none", "P": p}),
            json!({"R": turn, "t": [0, 0, 1]}),
        ] {
            assert_eq!(told(fields), None);
        }
    }

    /// They were passed over, so that an image of half the size was read with twice its focal length.
    #[test]
    fn a_matrix_of_another_image_is_refused() {
        let p = |scale: f64| {
            let [fx, fy, cx, cy] = K.map(|number| scale * number);
            [fx, 0.0, cx, -40.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0]
        };
        for (fields, parts) in [
            (json!({"binning_x": 2, "binning_y": 2}), ["`binning_x` is 2", "FX,FY,CX,CY"]),
            (json!({"binning_y": 4}), ["`binning_y` is 4", "more pixels"]),
            (json!({"binning_x": "2"}), ["`binning_x` is \"2\"", "more pixels"]),
            (json!({"roi": {"x_offset": 0, "y_offset": 60}}), ["y_offset 60", "was cut out"]),
            (json!({"P": p(1.1)}), ["`P` has fx 577.5", "rectified"]),
            (json!({"p": [p(0.9)[..4], p(0.9)[4..8], p(0.9)[8..]]}), ["`p` has fx 472.5", "525"]),
        ] {
            let error = told(fields.clone()).unwrap_or_default();
            assert!(parts.iter().all(|part| error.contains(part)), "{fields}: {error}");
        }
        let whole =
            json!({"x_offset": 0, "y_offset": 0, "width": 0, "height": 0, "do_rectify": false});
        for fields in [
            json!({"binning_x": 0, "binning_y": 0, "roi": whole, "P": p(1.0)}),
            json!({"binning_x": 1, "binning_y": null, "roi": null, "p": p(1.0 + 1e-6)}),
            json!({"P": vec![0.0; 12]}),
            json!({"p": [1]}),
            json!({}),
        ] {
            assert_eq!(told(fields), None);
        }
    }
}
