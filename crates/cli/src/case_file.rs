//! The case file of a batch.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use cloudtouch::geom::Pose;
use cloudtouch::noise::SensorModel;
use nalgebra::Matrix4;
use serde::Deserialize;
use serde_json::Value;
use serde_json::value::RawValue;

/// The cases of a file, in order. A case that cannot be read keeps its place and its reason.
#[derive(Debug)]
pub struct CaseFile {
    /// Each by its id, of which a case without one gets its number.
    pub cases: Vec<(String, Result<Case>)>,
}

/// One object in one scene at one pose.
#[derive(Debug, Clone)]
pub struct Case {
    /// A cloud or mesh, m.
    pub scene: PathBuf,
    /// A cloud or mesh, m.
    pub object: PathBuf,
    /// Maps the object into the scene.
    pub scene_from_object: Pose,
    /// What measured the scene, where the file says so.
    pub scene_sensor: Option<SensorModel>,
    /// What measured the object, where the file says so.
    pub object_sensor: Option<SensorModel>,
    /// What the file says the answer is, shown beside ours; never used.
    pub label: Option<String>,
    /// The true distance that the file claims, m; negative in overlap; never used either.
    pub signed_distance: Option<f64>,
    /// The case as it is written, with the fields that the tool passes over: what a label rests on,
    /// or to which series the case belongs.
    pub written: Value,
}

/// The cases are kept as they are written: what is wrong in one concerns no other.
#[derive(Deserialize)]
#[serde(rename = "case file")]
struct RawFile<'a> {
    format: u32,
    length_unit: String,
    #[serde(borrow)]
    cases: Vec<&'a RawValue>,
}

#[derive(Deserialize)]
struct RawCase {
    scene: PathBuf,
    object: PathBuf,
    pose: Value,
    scene_sensor: Option<String>,
    object_sensor: Option<String>,
    // Never used, so nothing about them is wrong.
    label: Option<Value>,
    in_collision: Option<Value>,
    signed_distance_m: Option<Value>,
}

/// Reads a case file of at most `max_bytes`; paths in it are relative to its folder.
///
/// # Errors
/// When the file is larger, or as a whole not a case file. A bad case does not spoil the others.
pub fn read(path: &Path, max_bytes: u64) -> Result<CaseFile> {
    let named = || path.display().to_string();
    let text = cloudtouch_io::read_bytes(path, max_bytes)?;
    parse(&text, path.parent().unwrap_or(Path::new(""))).with_context(named)
}

/// The cases in the text of a case file, whose paths are relative to `folder`.
///
/// # Errors
/// As [`read`].
pub fn parse(text: &[u8], folder: &Path) -> Result<CaseFile> {
    parse_whole(text, folder).map_err(shortened)
}

fn parse_whole(text: &[u8], folder: &Path) -> Result<CaseFile> {
    // Windows editors begin their files with a byte order mark.
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    if text.trim_ascii_start().starts_with(b"[") {
        bail!(
            "not a case file but a list: write \
             {{\"format\":1,\"length_unit\":\"m\",\"cases\":[...]}} around it"
        );
    }
    let text = without_bare_words(text);
    let raw: RawFile<'_> = serde_json::from_slice(&text)
        .context("not a case file, a JSON object with \"format\", \"length_unit\" and \"cases\"")?;
    if raw.format != 1 {
        bail!("format {}: this version reads format 1", raw.format);
    }
    if raw.length_unit != "m" {
        bail!("length_unit `{}`: poses must be in metres (\"m\")", raw.length_unit);
    }
    let cases = raw
        .cases
        .into_iter()
        .enumerate()
        .map(|(position, text)| {
            let number = format!("case-{}", position + 1);
            let case = serde_json::from_str::<Value>(text.get()).context("the case cannot be read");
            let case = case.and_then(|value| parse_case(value, folder)).map_err(shortened);
            (id(text.get()).unwrap_or(number), case)
        })
        .collect();
    Ok(CaseFile { cases })
}

/// The name a case has, if any, whatever is wrong with the rest of it.
fn id(case: &str) -> Option<String> {
    #[derive(Deserialize)]
    struct Named {
        id: Value,
    }
    match serde_json::from_str::<Named>(case).ok()?.id {
        Value::Null => None,
        Value::String(id) => Some(id),
        other => Some(other.to_string()),
    }
}

/// The text with strings of the same length for `NaN`, `Infinity` and `-Infinity`, which Python writes
/// and JSON does not have: they are wrong only where a number is used.
fn without_bare_words(text: &[u8]) -> Cow<'_, [u8]> {
    const WORDS: [(&[u8], &[u8]); 3] =
        [(b"-Infinity", b"\"-Infin.\""), (b"Infinity", b"\"Infin.\""), (b"NaN", b"\"N\"")];
    let mut text = Cow::Borrowed(text);
    let (mut at, mut in_string) = (0, false);
    while at < text.len() {
        match text[at] {
            b'\\' if in_string => at += 1,
            b'"' => in_string = !in_string,
            b'-' | b'I' | b'N' if !in_string => {
                let word = WORDS.iter().find(|(word, _)| text[at..].starts_with(word));
                if let Some((word, instead)) = word {
                    text.to_mut()[at..at + word.len()].copy_from_slice(instead);
                    at += word.len() - 1;
                }
            }
            _ => {}
        }
        at += 1;
    }
    text
}

fn parse_case(value: Value, folder: &Path) -> Result<Case> {
    if !value.is_object() {
        bail!("the case is not a JSON object but {}", kind(&value));
    }
    let raw = RawCase::deserialize(&value)?;
    let rows: Vec<[f64; 4]> = serde_json::from_value(raw.pose)
        .context("the pose is not a list of four rows of four numbers")?;
    if rows.len() != 4 {
        bail!("the pose has {} rows: it must be 4x4", rows.len());
    }
    let entries = rows.concat();
    let sensor = |spec: Option<String>| {
        spec.map(|s| s.parse::<SensorModel>().map_err(|error| anyhow!("{error}"))).transpose()
    };
    Ok(Case {
        scene: folder.join(raw.scene),
        object: folder.join(raw.object),
        scene_from_object: Pose::try_from_matrix(&Matrix4::from_row_slice(&entries))?,
        scene_sensor: sensor(raw.scene_sensor)?,
        object_sensor: sensor(raw.object_sensor)?,
        label: raw.label.and_then(spelled).or_else(|| {
            let hit = raw.in_collision?.as_bool()?;
            Some(if hit { "collision" } else { "apart" }.to_owned())
        }),
        signed_distance: raw.signed_distance_m.and_then(|distance| distance.as_f64()),
        written: value,
    })
}

/// The error with its causes in one message, of which no more is kept than its beginning and its
/// end: messages quote what they found, which may be most of the file, and then say where.
fn shortened(error: anyhow::Error) -> anyhow::Error {
    const KEPT: usize = 200;
    let message = format!("{error:#}");
    let characters = message.chars().count();
    if characters <= 2 * KEPT {
        return error;
    }
    let start: String = message.chars().take(KEPT).collect();
    let end: String = message.chars().skip(characters - KEPT).collect();
    anyhow!("{start} ... {end}")
}

/// A label as text, whatever it is.
fn spelled(label: Value) -> Option<String> {
    match label {
        Value::Null => None,
        Value::String(label) => Some(label),
        other => Some(other.to_string()),
    }
}

fn kind(value: &Value) -> &'static str {
    match value {
        Value::Null => "null",
        Value::Bool(_) => "a truth value",
        Value::Number(_) => "a number",
        Value::String(_) => "a string",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        let file = parse(text.as_bytes(), Path::new(""));
        let error = file.and_then(|mut file| file.cases.remove(0).1.map(|_| ())).unwrap_err();
        format!("{error:#}")
    }

    #[test]
    fn messages_quote_no_more_than_an_excerpt_and_still_say_where() {
        let long = "x".repeat(100_000);
        let whole = message(&format!("\"{long}\""));
        assert!(whole.len() < 450 && whole.ends_with("at line 1 column 100002"), "{whole}");
        let case = |sensor: &str| {
            let pose = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";
            let case =
                format!(r#"{{"scene":"a","object":"b","pose":{pose},"scene_sensor":"{sensor}"}}"#);
            message(&format!(r#"{{"format":1,"length_unit":"m","cases":[{case}]}}"#))
        };
        let spec = case(&long);
        assert!(spec.len() < 450 && spec.starts_with("unknown sensor `xxx"), "{spec}");
        assert!(case("sonar").contains("`sonar`"));
        let unit = message(&format!(r#"{{"format":1,"length_unit":"{long}","cases":[]}}"#));
        assert!(unit.len() < 450 && unit.ends_with("(\"m\")"), "{unit}");
    }
}
