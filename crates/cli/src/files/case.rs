//! The case file of a batch.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use cloudtouch::geom::Pose;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;
use serde_json::value::RawValue;

use crate::files::json::{matrix, shortened, without_bare_words};
use crate::files::{case_fields, fields};
use crate::sensor::SensorChoice;

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
    pub scene_sensor: Option<SensorChoice>,
    /// What measured the object, where the file says so.
    pub object_sensor: Option<SensorChoice>,
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
    scene: Value,
    object: Value,
    pose: Value,
    scene_sensor: Option<Value>,
    object_sensor: Option<Value>,
    // Never used, so nothing about them is wrong.
    label: Option<Value>,
    in_collision: Option<Value>,
    signed_distance_m: Option<Value>,
}

impl CaseFile {
    /// Names that two cases have, with the places from 1 of the first two.
    pub fn same_names(&self) -> Vec<(&str, [usize; 2])> {
        let mut first = BTreeMap::new();
        let mut same = BTreeMap::new();
        for (index, (id, _)) in self.cases.iter().enumerate() {
            let place = index + 1;
            let known = *first.entry(id.as_str()).or_insert(place);
            if known != place {
                same.entry(id.as_str()).or_insert([known, place]);
            }
        }
        same.into_iter().collect()
    }
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
    // What is of each case, or of none, would be passed over here.
    let beside: BTreeMap<String, Option<IgnoredAny>> = serde_json::from_slice(&text)?;
    let given = beside.iter().filter(|(_, value)| value.is_some());
    given.map(|(name, _)| name).try_for_each(|name| case_fields::check_beside(name))?;
    if raw.cases.is_empty() {
        bail!("there are no cases: `cases` is an empty list");
    }
    let cases = raw
        .cases
        .into_iter()
        .enumerate()
        .map(|(position, text)| {
            let number = format!("case-{}", position + 1);
            let case = serde_json::from_str::<Value>(text.get()).context("the case cannot be read");
            let case = case.and_then(|value| parse_case(value, text.get(), folder));
            (id(text.get()).unwrap_or(number), case.map_err(shortened))
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

/// A case, and the text that it was read from.
fn parse_case(value: Value, text: &str, folder: &Path) -> Result<Case> {
    let Value::Object(given) = &value else {
        bail!("the case is not a JSON object but {}", kind(&value));
    };
    fields::check_once(text)?;
    case_fields::check(given)?;
    let raw = RawCase::deserialize(&value)?;
    let scene_from_object = matrix(raw.pose)?;
    let sensor = |name: &str, spec: Option<Value>| -> Result<Option<SensorChoice>> {
        let Some(spec) = spec else { return Ok(None) };
        fields::text(name, spec)?.parse().map(Some).map_err(|error| anyhow!("{error}"))
    };
    Ok(Case {
        scene: folder.join(fields::file("scene", raw.scene)?),
        object: folder.join(fields::file("object", raw.object)?),
        scene_from_object,
        scene_sensor: sensor("scene_sensor", raw.scene_sensor)?,
        object_sensor: sensor("object_sensor", raw.object_sensor)?,
        label: raw.label.and_then(spelled).or_else(|| {
            let hit = raw.in_collision?.as_bool()?;
            Some(if hit { "collision" } else { "apart" }.to_owned())
        }),
        signed_distance: raw.signed_distance_m.and_then(|distance| distance.as_f64()),
        written: value,
    })
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
