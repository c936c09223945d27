//! The file of a scene: bodies, what moves with what, and what may touch.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, anyhow, bail};
use cloudtouch::geom::Pose;
use cloudtouch_io::LengthUnit;
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use serde_json::value::RawValue;

use crate::files::fields;
use crate::files::json::{as_written, matrix, shortened, without_bare_words};
use crate::intrinsics::{self, DepthImages, Intrinsics};

/// A scene as its file says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SceneFile {
    /// Pairs with a probability of so much are not free; what the options say where it is not given.
    pub threshold: Option<f64>,
    /// In the order of the file; names may be taken twice, and unknown ones be attached to.
    pub bodies: Vec<BodyEntry>,
    /// Pairs that may touch, by names.
    pub allowed: Vec<[String; 2]>,
}

/// A body of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyEntry {
    /// By which others refer to it.
    pub name: String,
    /// A cloud or a mesh.
    pub file: PathBuf,
    /// The spec of its sensor, as in the options.
    pub sensor: Option<String>,
    /// Where that stood in the frame of a cloud, m; what the file says where it is not given.
    pub sensor_pose: Option<Pose>,
    /// In which its coordinates are.
    pub unit: Option<LengthUnit>,
    /// What is said of it as a depth image.
    pub depth: DepthImages,
    /// Into the frame of what it is attached to, or else of the scene, m; the identity where none is
    /// given.
    pub pose: Pose,
    /// The name of the body that it moves with.
    pub attached_to: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename = "scene file", deny_unknown_fields)]
struct RawFile<'a> {
    format: u32,
    length_unit: String,
    threshold: Option<Value>,
    #[serde(borrow)]
    bodies: Vec<&'a RawValue>,
    #[serde(default)]
    allowed: Vec<Value>,
}

/// What is misspelt would be passed over: an unknown field is an error.
#[derive(Deserialize)]
#[serde(rename = "body", deny_unknown_fields)]
struct RawBody {
    name: Value,
    file: Value,
    sensor: Option<Value>,
    #[serde(default, deserialize_with = "given")]
    sensor_pose: Option<Value>,
    unit: Option<Value>,
    intrinsics: Option<Value>,
    depth_scale: Option<Value>,
    #[serde(default, deserialize_with = "given")]
    pose: Option<Value>,
    #[serde(default, deserialize_with = "given")]
    attached_to: Option<Value>,
}

/// What is there, `null` too: a pose that a program does not know is not the one that is left out.
fn given<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Value>, D::Error> {
    Value::deserialize(deserializer).map(Some)
}

/// Reads a scene file of at most `max_bytes`; paths in it are relative to its folder.
///
/// # Errors
/// When the file is larger or no scene file; the message names the body, by its place from 1 and its
/// name, and the field.
pub fn read(path: &Path, max_bytes: u64) -> Result<SceneFile> {
    let named = || path.display().to_string();
    let text = cloudtouch_io::read_bytes(path, max_bytes)?;
    parse(&text, path.parent().unwrap_or(Path::new(""))).with_context(named)
}

/// The scene in the text of a scene file, whose paths are relative to `folder`.
///
/// # Errors
/// As [`read`].
pub fn parse(text: &[u8], folder: &Path) -> Result<SceneFile> {
    parse_whole(text, folder).map_err(shortened)
}

/// Reads what a robot holds: a scene file of bodies that are attached to links.
///
/// # Errors
/// As [`read`], and when a body is attached to nothing or there is a threshold.
pub fn read_held(path: &Path, max_bytes: u64) -> Result<SceneFile> {
    let named = || path.display().to_string();
    let text = cloudtouch_io::read_bytes(path, max_bytes)?;
    parse_held(&text, path.parent().unwrap_or(Path::new(""))).with_context(named)
}

fn parse_held(text: &[u8], folder: &Path) -> Result<SceneFile> {
    let file = parse_any(text, folder).map_err(shortened)?;
    if file.bodies.is_empty() {
        bail!("no bodies: name what is held, or leave the file out");
    }
    if file.threshold.is_some() {
        bail!("`threshold` is of a scene: leave it out, and give --reject");
    }
    let loose = file.bodies.iter().enumerate().find(|(_, body)| body.attached_to.is_none());
    if let Some((index, body)) = loose {
        bail!("body {} `{}`: give `attached_to`, the link that holds it", index + 1, body.name);
    }
    Ok(file)
}

fn parse_whole(text: &[u8], folder: &Path) -> Result<SceneFile> {
    let file = parse_any(text, folder)?;
    match file.bodies.len() {
        0 => bail!("no bodies: a scene needs at least two that may touch"),
        1 => bail!("one body: a scene needs at least two that may touch"),
        _ => Ok(file),
    }
}

fn parse_any(text: &[u8], folder: &Path) -> Result<SceneFile> {
    let text = without_bare_words(text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text));
    let raw: RawFile<'_> = serde_json::from_slice(&text).context(
        "not a scene file, a JSON object with \"format\", \"length_unit\" and \"bodies\"",
    )?;
    if raw.format != 1 {
        bail!("format {}: this version reads format 1", raw.format);
    }
    if raw.length_unit != "m" {
        bail!("length_unit `{}`: poses must be in metres (\"m\")", raw.length_unit);
    }
    let body = |(index, text): (usize, &RawValue)| {
        let value: Value = serde_json::from_str(text.get())
            .with_context(|| format!("body {} cannot be read", index + 1))?;
        let name = value.get("name").and_then(Value::as_str).map(|name| format!(" `{name}`"));
        let place = || format!("body {}{}", index + 1, name.unwrap_or_default());
        body(value, text.get(), folder).with_context(place)
    };
    let pair = |(index, value): (usize, Value)| {
        let form = || format!("pair {} of \"allowed\" is not a list of two names", index + 1);
        serde_json::from_value(value).with_context(form)
    };
    Ok(SceneFile {
        threshold: raw.threshold.map(threshold).transpose()?,
        bodies: raw.bodies.into_iter().enumerate().map(body).collect::<Result<_>>()?,
        allowed: raw.allowed.into_iter().enumerate().map(pair).collect::<Result<_>>()?,
    })
}

fn threshold(value: Value) -> Result<f64> {
    match value.as_f64() {
        Some(threshold) if (0.0..=0.5).contains(&threshold) => Ok(threshold),
        _ => bail!("threshold {value}: give a probability from 0 to 0.5"),
    }
}

/// A body, and the text that it was read from.
fn body(value: Value, text: &str, folder: &Path) -> Result<BodyEntry> {
    // Of a list the fields would be taken by their order.
    if !value.is_object() {
        bail!("is {}: write a JSON object", as_written(&value));
    }
    fields::check_once(text)?;
    let raw = RawBody::deserialize(value)?;
    let name = fields::text("name", raw.name)?;
    if name.trim().is_empty() {
        bail!("its `name` is empty: give it one, by which answers call it");
    }
    let depth = DepthImages {
        intrinsics: raw.intrinsics.map(|value| stated(value, folder)).transpose()?,
        depth_scale: raw.depth_scale.map(depth_scale).transpose()?,
    };
    let text =
        |name, value: Option<Value>| value.map(|value| fields::text(name, value)).transpose();
    let unit = text("unit", raw.unit)?.map(|unit| unit.parse::<LengthUnit>()).transpose();
    Ok(BodyEntry {
        name,
        file: folder.join(fields::file("file", raw.file)?),
        sensor: text("sensor", raw.sensor)?,
        sensor_pose: raw.sensor_pose.map(matrix).transpose().context("`sensor_pose`")?,
        unit: unit?,
        depth,
        pose: raw.pose.map(matrix).transpose()?.unwrap_or_default(),
        attached_to: text("attached_to", raw.attached_to)?,
    })
}

/// Four numbers, or the name of a file in the folder of the scene file.
fn stated(value: Value, folder: &Path) -> Result<Intrinsics> {
    let read = match &value {
        Value::String(text) => Intrinsics::parse(text),
        _ => match serde_json::from_value::<[f64; 4]>(value.clone()) {
            Ok(numbers) => Intrinsics::of_numbers(numbers),
            Err(_) => Err("give [fx, fy, cx, cy] in pixels, or the name of a file".to_owned()),
        },
    };
    match read {
        Ok(Intrinsics::File(file)) => Ok(Intrinsics::File(folder.join(file))),
        Ok(numbers) => Ok(numbers),
        Err(why) => bail!("`intrinsics` is {}: {why}", as_written(&value)),
    }
}

fn depth_scale(value: Value) -> Result<f64> {
    let Some(scale) = value.as_f64() else {
        bail!("`depth_scale` is {}: give metres a step, such as 0.001", as_written(&value))
    };
    intrinsics::depth_scale(scale).map_err(|why| anyhow!("`depth_scale`: {why}"))
}
