//! What all JSON files of the tool have in common: numbers that JSON does not have, poses, messages.

use std::borrow::Cow;

use anyhow::{Result, anyhow, bail};
use cloudtouch::LARGEST_COORDINATE;
use cloudtouch::geom::Pose;
use cloudtouch::geom::message::number;
use nalgebra::Matrix4;
use serde_json::Value;

/// A pose as four rows of four numbers, m.
pub(crate) fn matrix(value: Value) -> Result<Pose> {
    let Value::Array(rows) = &value else { bail!("the pose is {}: {FORM}", as_written(&value)) };
    let mut entries = Vec::with_capacity(16);
    for (row, found) in rows.iter().enumerate() {
        entries.extend(row_of(row, found)?);
    }
    if rows.len() != 4 {
        bail!("the pose has {} rows: {FORM}", rows.len());
    }
    within_reach(Pose::try_from_matrix(&Matrix4::from_row_slice(&entries))?)
}

/// Refuses a pose beyond all coordinates.
pub(crate) fn within_reach(pose: Pose) -> Result<Pose> {
    for (row, length) in pose.translation().iter().enumerate() {
        if length.abs() > LARGEST_COORDINATE {
            let length = number(*length);
            bail!(
                "({row}, 3) is {length}: a pose is in metres, and at most {LARGEST_COORDINATE:e} m"
            );
        }
    }
    Ok(pose)
}

const FORM: &str = "write four rows of four numbers";

fn row_of(row: usize, found: &Value) -> Result<[f64; 4]> {
    let Value::Array(entries) = found else {
        bail!("row {row} of the pose is {}: {FORM}", as_written(found));
    };
    let mut numbers = [0.0; 4];
    for (column, entry) in entries.iter().enumerate() {
        let Some(number) = entry.as_f64() else {
            let found = as_written(entry);
            bail!(
                "the pose is not four rows of four numbers: ({row}, {column}) is {found}: every entry must be a \
                 finite number"
            );
        };
        if let Some(place) = numbers.get_mut(column) {
            *place = number;
        }
    }
    match entries.len() {
        4 => Ok(numbers),
        count => bail!("row {row} of the pose has {count} numbers: {FORM}"),
    }
}

/// A value as the file has it, before it was [without bare words](without_bare_words).
pub(crate) fn as_written(value: &Value) -> String {
    let text = value.to_string();
    let word = WORDS.iter().find(|(_, instead)| *instead == text.as_bytes());
    word.map_or(text, |(word, _)| String::from_utf8_lossy(word).into_owned())
}

/// Numbers that JSON does not have, and what is read in their place.
const WORDS: [(&[u8], &[u8]); 3] =
    [(b"-Infinity", b"\"-Infin.\""), (b"Infinity", b"\"Infin.\""), (b"NaN", b"\"N\"")];

/// The text with strings of the same length for `NaN`, `Infinity` and `-Infinity`, which Python writes
/// and JSON does not have: they are wrong only where a number is used.
pub(crate) fn without_bare_words(text: &[u8]) -> Cow<'_, [u8]> {
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

/// The error with its causes in one message, of which no more is kept than its beginning and its
/// end: messages quote what they found, which may be most of the file, and then say where.
pub(crate) fn shortened(error: anyhow::Error) -> anyhow::Error {
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
