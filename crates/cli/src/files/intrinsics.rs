//! The intrinsics of a camera in a file, as data sets and drivers write them.

use std::path::Path;

use anyhow::{Context as _, Result, bail, ensure};
use cloudtouch_io::DepthCamera;
use serde_json::{Map, Value};

use crate::files::camera_info;
use crate::files::distortion;
use crate::files::fields::check_once;
use crate::files::json::{as_written, shortened, without_bare_words};

/// What a file says of a camera.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraFile {
    /// Its intrinsics, and the size of the image they are of where the file says it; in millimetres, unless
    /// the file says otherwise beyond doubt.
    pub camera: DepthCamera,
    /// A `depth_scale` or the like, as in "`depth_scale` is 5000", whose unit the file does not tell: metres a step,
    /// millimetres, or steps a metre.
    pub unclear_scale: Option<String>,
}

/// Names under which a 3 x 3 matrix stands: ROS, BOP, Open3D.
const MATRICES: [&str; 4] = ["K", "k", "cam_K", "intrinsic_matrix"];
/// Names of columns and rows.
const SIZES: [[&str; 2]; 3] = [["width", "height"], ["image_width", "image_height"], ["w", "h"]];
const FORMS: &str = "write {\"fx\": 525, \"fy\": 525, \"cx\": 319.5, \"cy\": 239.5}, or a 3 x 3 matrix as \
                     \"K\", \"cam_K\" or \"intrinsic_matrix\"";

/// Reads a file of at most `max_bytes` with the intrinsics of the camera of an image, whose name tells
/// which of many cameras is its.
///
/// JSON with `fx`, `fy`, `cx` and `cy` (`ppx` and `ppy`), or with a matrix `K` or `k` (ROS CameraInfo),
/// `cam_K` (BOP; one for each image by its number too) or `intrinsic_matrix` (Open3D); or nine numbers as
/// text. A matrix is taken row by row or column by column, whichever makes it one of a camera.
///
/// # Errors
/// When the file is larger or malformed, has no intrinsics or several that differ, a skew, distortion, or a
/// CameraInfo that is of another image.
pub fn read(path: &Path, image: &Path, max_bytes: u64) -> Result<CameraFile> {
    let text = cloudtouch_io::read_bytes(path, max_bytes)?;
    let image = image.file_stem().map(|stem| stem.to_string_lossy()).unwrap_or_default();
    parse(&text, &image).with_context(|| path.display().to_string())
}

/// The intrinsics in the text of such a file, of the camera of an image with this name.
///
/// # Errors
/// As [`read`].
pub fn parse(text: &[u8], image: &str) -> Result<CameraFile> {
    let file = parse_whole(text, image).map_err(shortened)?;
    file.camera.validate()?;
    Ok(file)
}

fn parse_whole(text: &[u8], image: &str) -> Result<CameraFile> {
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text).trim_ascii();
    if !text.starts_with(b"{") && !text.starts_with(b"[") {
        return of_text(text);
    }
    let text = without_bare_words(text);
    let value: Value = serde_json::from_slice(&text)
        .with_context(|| format!("not the intrinsics of a camera: {FORMS}"))?;
    match &value {
        Value::Object(fields) => {
            check_once(&String::from_utf8_lossy(&text))?;
            of_object(of_image(fields, image)?)
        }
        matrix => Ok(of_numbers(of_matrix("the matrix", matrix)?)),
    }
}

/// Nine numbers, as `numpy.savetxt` writes a matrix.
fn of_text(text: &[u8]) -> Result<CameraFile> {
    let text = String::from_utf8_lossy(text);
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or_default());
    let words = lines.flat_map(|line| line.split(|c: char| c == ',' || c.is_whitespace()));
    let numbers: Option<Vec<f64>> =
        words.filter(|word| !word.is_empty()).map(|word| word.parse().ok()).collect();
    let Some(numbers) = numbers.filter(|numbers| numbers.len() == 9) else {
        bail!(
            "neither JSON nor the nine numbers of a 3 x 3 matrix: {FORMS}; of a YAML file give its fx,fy,cx,cy"
        );
    };
    Ok(of_numbers(pinhole("the matrix", &numbers)?))
}

/// The camera of an image where a file has one for each, by its number.
fn of_image<'a>(fields: &'a Map<String, Value>, image: &str) -> Result<&'a Map<String, Value>> {
    let of_one = |value: &'a Value| value.as_object().filter(|of| of.contains_key("cam_K"));
    if fields.is_empty() || !fields.values().all(|value| of_one(value).is_some()) {
        return Ok(fields);
    }
    let found = fields
        .iter()
        .find(|(number, _)| number.parse::<u64>().is_ok_and(|n| image.parse() == Ok(n)))
        .and_then(|(_, value)| of_one(value));
    found.with_context(|| {
        format!(
            "has the cameras of {} images by their numbers, and none for `{image}`: name the image by its \
             number, or give the camera of one alone",
            fields.len()
        )
    })
}

fn of_object(fields: &Map<String, Value>) -> Result<CameraFile> {
    let mut stated = Vec::new();
    for name in MATRICES {
        if let Some(matrix) = fields.get(name) {
            stated.push((name, of_matrix(name, matrix)?));
        }
    }
    for (cx, cy) in [("cx", "cy"), ("ppx", "ppy")] {
        let names = ["fx", "fy", cx, cy];
        if fields.contains_key(cx) || fields.contains_key(cy) {
            let values = names.map(|name| number(fields, name));
            let [fx, fy, cx, cy] = values;
            stated.push(("fx", [fx?, fy?, cx?, cy?]));
        }
    }
    let Some(((first, numbers), others)) = stated.split_first() else {
        bail!("there are no intrinsics of a camera: {FORMS}");
    };
    if let Some((other, _)) = others.iter().find(|(_, of_other)| of_other != numbers) {
        bail!("`{first}` and `{other}` say different intrinsics: leave out one of them");
    }
    distortion::check(fields)?;
    camera_info::check(fields, *numbers)?;
    let CameraFile { mut camera, .. } = of_numbers(*numbers);
    for names in SIZES {
        camera.image_size = camera.image_size.or(size(fields, names)?);
    }
    if let Some(Value::Array(pair)) = fields.get("resolution")
        && let [width, height] = &pair[..]
    {
        let stated = known((pixels("resolution", width)?, pixels("resolution", height)?));
        camera.image_size = camera.image_size.or(stated);
    }
    // Only BOP has this name for its matrix, and its scale makes millimetres.
    let is_of_bop = fields.contains_key("cam_K") && fields.contains_key("depth_scale");
    if is_of_bop {
        camera.depth_scale = 0.001 * number(fields, "depth_scale")?;
    }
    let unclear = fields.iter().find(|(name, _)| !is_of_bop && is_of_steps(name));
    let unclear_scale = unclear.map(|(name, value)| {
        // It may be anything, of any length.
        let value: String = as_written(value).chars().take(40).collect();
        format!("`{name}` is {value}")
    });
    Ok(CameraFile { camera, unclear_scale })
}

/// `depth_scale`, `png_depth_scale`, `DepthMapFactor`, `depth_units` and the like, and the `scale` of NICE-SLAM.
fn is_of_steps(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let is_step = || ["scale", "factor", "unit"].iter().any(|word| name.contains(word));
    name == "scale" || (name.contains("depth") && is_step())
}

/// Columns and rows, where they are stated.
fn size(fields: &Map<String, Value>, names: [&str; 2]) -> Result<Option<(usize, usize)>> {
    let [width, height] = names.map(|name| fields.get(name).filter(|value| !value.is_null()));
    let (width, height) = match (width, height) {
        (Some(width), Some(height)) => (pixels(names[0], width)?, pixels(names[1], height)?),
        (None, None) => return Ok(None),
        (width, height) => {
            let [there, missing] = if width.is_some() { names } else { [names[1], names[0]] };
            let value = width.or(height).map(as_written).unwrap_or_default();
            bail!("`{there}` is {value}, and there is no `{missing}`: give both, or leave it out");
        }
    };
    Ok(known((width, height)))
}

/// No columns and no rows are what drivers write that do not know them.
fn known(size: (usize, usize)) -> Option<(usize, usize)> {
    (size != (0, 0)).then_some(size)
}

/// A number of pixels; `640.0` is what some programs write.
fn pixels(name: &str, value: &Value) -> Result<usize> {
    let whole = value.as_f64().filter(|size| size.fract() == 0.0 && (0.0..1e9).contains(size));
    whole.map(|size| size as usize).with_context(|| {
        format!("`{name}` is {}: give a whole number of pixels", as_written(value))
    })
}

fn of_numbers([fx, fy, cx, cy]: [f64; 4]) -> CameraFile {
    CameraFile { camera: DepthCamera::new(fx, fy, cx, cy), unclear_scale: None }
}

fn number(fields: &Map<String, Value>, name: &str) -> Result<f64> {
    let value = fields.get(name).with_context(|| format!("there is no `{name}`: {FORMS}"))?;
    value.as_f64().with_context(|| format!("`{name}` is {}: give a number", as_written(value)))
}

/// Three rows of three numbers, or nine numbers.
fn of_matrix(name: &str, value: &Value) -> Result<[f64; 4]> {
    let form =
        || format!("`{name}` is no list of nine numbers, or of three rows of three: {FORMS}");
    let list = value.as_array().with_context(form)?;
    let rows =
        list.iter().map(|row| row.as_array().map_or(std::slice::from_ref(row), Vec::as_slice));
    let numbers: Option<Vec<f64>> = rows.flatten().map(Value::as_f64).collect();
    let numbers = numbers.filter(|numbers| numbers.len() == 9).with_context(form)?;
    pinhole(name, &numbers)
}

/// fx, fy, cx and cy of a matrix, row by row or column by column: of one that has a principal point only one
/// of both is a camera's.
fn pinhole(name: &str, matrix: &[f64]) -> Result<[f64; 4]> {
    let is_by_columns = matrix[2] == 0.0 && matrix[5] == 0.0;
    let at = |row: usize, column: usize| {
        matrix[if is_by_columns { 3 * column + row } else { 3 * row + column }]
    };
    let expected = [(0, 1, 0.0), (1, 0, 0.0), (2, 0, 0.0), (2, 1, 0.0), (2, 2, 1.0)];
    for (row, column, wanted) in expected {
        let found = at(row, column);
        ensure!(
            found == wanted,
            "`{name}` has {found} in row {} and column {}, where a camera without skew has {wanted}: give \
             [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]",
            row + 1,
            column + 1
        );
    }
    Ok([at(0, 0), at(1, 1), at(0, 2), at(1, 2)])
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    const WANTED: [f64; 4] = [525.0, 526.0, 319.5, 239.25];

    fn read(text: &str) -> CameraFile {
        let file = parse(text.as_bytes(), "000012").unwrap();
        let DepthCamera { fx, fy, cx, cy, .. } = file.camera;
        assert_eq!([fx, fy, cx, cy], WANTED, "{text}");
        file
    }

    #[test]
    fn what_data_sets_and_drivers_write_is_read() {
        let plain = read(r#"{"fx": 525, "fy": 526, "cx": 319.5, "cy": 239.25}"#);
        assert_eq!(
            plain,
            CameraFile {
                camera: DepthCamera::new(525.0, 526.0, 319.5, 239.25),
                unclear_scale: None
            }
        );
        // librealsense.
        let real = r#"{"width": 640, "height": 480, "fx": 525, "fy": 526, "ppx": 319.5, "ppy": 239.25,
            "model": "distortion.brown_conrady", "coeffs": [0.0, 0.0, 0.0, 0.0, 0.0]}"#;
        assert_eq!(read(real).camera.image_size, Some((640, 480)));
        let of_floats = real.replace("640", "640.0");
        assert_eq!(read(&of_floats).camera.image_size, Some((640, 480)));
        let unknown = real.replace("640", "0").replace("480", "0");
        assert_eq!(read(&unknown).camera.image_size, None);
        // CameraInfo of ROS 1 and 2.
        let matrix = "[525, 0, 319.5, 0, 526, 239.25, 0, 0, 1]";
        read(&format!(r#"{{"height": 480, "width": 640, "D": [0, 0], "K": {matrix}, "P": [1]}}"#));
        read(&format!(r#"{{"header": {{"frame_id": "a"}}, "d": [], "k": {matrix}}}"#));
        // Open3D, column by column.
        let open = r#"{"width": 640, "height": 480,
            "intrinsic_matrix": [525, 0, 0, 0, 526, 0, 319.5, 239.25, 1]}"#;
        assert_eq!(read(open).camera.image_size, Some((640, 480)));
        // BOP, where the scale makes millimetres: of one image, and of all by their numbers.
        let of_one = format!(r#"{{"cam_K": {matrix}, "depth_scale": 0.1}}"#);
        assert!((read(&of_one).camera.depth_scale - 1e-4).abs() < 1e-19);
        let other = r#"{"cam_K": [1, 0, 1, 0, 1, 1, 0, 0, 1], "depth_scale": 1.0}"#;
        let all = format!(r#"{{"1": {other}, "12": {of_one}}}"#);
        assert_eq!(read(&all).camera, read(&of_one).camera);
        let none = parse(all.as_bytes(), "000013").unwrap_err().to_string();
        assert!(none.contains("2 images") && none.contains("`000013`"), "{none}");
        // A matrix alone.
        read("[[525, 0, 319.5], [0, 526, 239.25], [0, 0, 1]]");
        read("# K\n5.25e+02 0.0 319.5\n0 526 239.25\n0 0 1\n");
        // Others write metres a step, or steps a metre, under the same name.
        let scaled = r#"{"fx": 525, "fy": 526, "cx": 319.5, "cy": 239.25, "depth_scale": 1000}"#;
        assert_eq!(read(scaled).unclear_scale.as_deref(), Some("`depth_scale` is 1000"));
        let sized = scaled.replace("\"depth_scale\": 1000", "\"w\": 640, \"h\": 480");
        assert_eq!(read(&sized).camera.image_size, Some((640, 480)));
        // It was not compared with the image.
        let sized = scaled.replace("\"depth_scale\": 1000", "\"resolution\": [640, 480]");
        assert_eq!(read(&sized).camera.image_size, Some((640, 480)));
        assert_eq!(read(&sized.replace("640, 480", "0, 0")).camera.image_size, None);
    }

    /// Under any other name than `depth_scale` it was passed over, and steps were taken for millimetres.
    #[test]
    fn a_step_of_depth_is_known_by_any_of_its_names() {
        let plain = r#"{"fx": 525, "fy": 526, "cx": 319.5, "cy": 239.25, "NAME": 5000}"#;
        for name in ["png_depth_scale", "depthScale", "DepthMapFactor", "depth_units", "scale"] {
            let stated = format!("`{name}` is 5000");
            assert_eq!(read(&plain.replace("NAME", name)).unclear_scale, Some(stated));
        }
        for name in ["max_depth", "scaled", "unit", "depth_frame"] {
            assert_eq!(read(&plain.replace("NAME", name)).unclear_scale, None, "{name}");
        }
        let of_bop = r#"{"cam_K": [525, 0, 319.5, 0, 526, 239.25, 0, 0, 1], "depth_factor": 10}"#;
        assert_eq!(read(of_bop).unclear_scale.as_deref(), Some("`depth_factor` is 10"));
    }

    #[test]
    fn what_is_not_clear_is_refused_with_what_to_write() {
        let long = "x".repeat(10_000);
        for (text, parts) in [
            ("", &["neither JSON", "\"fx\": 525"][..]),
            ("camera_matrix:\n  data: [525, 0, 319.5]", &["neither JSON", "of a YAML file"]),
            ("{\"fx\": 525", &["not the intrinsics of a camera", "\"cam_K\""]),
            ("{}", &["no intrinsics"]),
            (r#"{"fx": 525, "fy": 525, "cx": 319.5}"#, &["no `cy`"]),
            (r#"{"fx": NaN, "fy": 525, "cx": 319.5, "cy": 1}"#, &["`fx` is NaN", "number"]),
            (r#"{"fx": 0, "fy": 525, "cx": 319.5, "cy": 1}"#, &["fx is 0", "above 0"]),
            (r#"{"fx": 1e999, "fy": 525, "cx": 319.5, "cy": 1}"#, &["not the intrinsics"]),
            (
                r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 3, "width": "640", "height": 480}"#,
                &["`width` is", "whole number of pixels"],
            ),
            // One alone was passed over.
            (
                r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 3, "width": 1280}"#,
                &["`width` is 1280", "no `height`", "give both"],
            ),
            (r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 3, "w": null, "h": 7}"#, &["`h` is 7", "no `w`"]),
            (
                r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 3, "resolution": [640, "480"]}"#,
                &["`resolution` is \"480\"", "whole number of pixels"],
            ),
            (r#"{"K": [1, 2, 3]}"#, &["`K` is no list of nine"]),
            (r#"{"K": [525, 3, 319, 0, 525, 239, 0, 0, 1]}"#, &["`K` has 3", "without skew"]),
            (r#"{"K": [525, 0, 319, 0, 525, 239, 0, 0, 2]}"#, &["has 2 in row 3 and column 3"]),
            (
                r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 3, "K": [6, 0, 3, 0, 5, 3, 0, 0, 1]}"#,
                &["`K` and `fx` say different"],
            ),
            (
                r#"{"k": [5, 0, 3, 0, 5, 3, 0, 0, 1], "d": [0, -0.2]}"#,
                &["`d` has -0.2", "rectify", "P"],
            ),
            (
                r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 3, "k1": 0.1}"#,
                &["`k1` has 0.1", "without distortion"],
            ),
            // The last of them counted.
            (r#"{"fx": 5, "fy": 5, "cx": 3, "cy": 3, "fx": 6}"#, &["`fx` is there twice"]),
            (&format!("{{\"fx\": \"{long}\", \"cx\": 1}}"), &["`fx` is", "give a number"]),
        ] {
            let error = format!("{:#}", parse(text.as_bytes(), "1").unwrap_err());
            assert!(parts.iter().all(|part| error.contains(part)), "{text}: {error}");
            assert!(error.len() < 500, "{error}");
        }
    }
}
