//! Positions of joints in a file.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context as _, Result, bail};
use serde_json::Value;

use crate::files::fields::Names;
use crate::files::json::{as_written, shortened, without_bare_words};

/// Positions of joints by name, rad or m.
pub type Joints = BTreeMap<String, f64>;

/// Reads an object of positions, or a list of at least two, of at most `max_bytes`.
///
/// # Errors
/// When the file is larger or malformed; the message names the place in the list and the joint.
pub fn read(path: &Path, max_bytes: u64) -> Result<Vec<Joints>> {
    let text = cloudtouch_io::read_bytes(path, max_bytes)?;
    parse(&text).map_err(shortened).with_context(|| path.display().to_string())
}

/// The positions in the text of such a file.
///
/// # Errors
/// As [`read`].
pub fn parse(text: &[u8]) -> Result<Vec<Joints>> {
    let text = without_bare_words(text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text));
    let value: Value = serde_json::from_slice(&text)
        .context("not a JSON object of joint names and positions, nor a list of such objects")?;
    let is_list = value.is_array();
    let read = match value {
        Value::Array(list) if list.len() < 2 => {
            bail!(
                "too few positions ({}): a path needs two; write one as an object alone",
                list.len()
            )
        }
        Value::Array(list) => {
            let read = |(index, one)| positions(one).with_context(|| place(index));
            list.into_iter().enumerate().map(read).collect::<Result<_>>()?
        }
        one => vec![positions(one)?],
    };
    // The last of two would have counted.
    if is_list {
        let names: Vec<Names> = serde_json::from_slice(&text)?;
        for (index, names) in names.iter().enumerate() {
            given_once(names).with_context(|| place(index))?;
        }
    } else {
        given_once(&serde_json::from_slice(&text)?)?;
    }
    Ok(read)
}

fn given_once(names: &Names) -> Result<()> {
    match names.twice() {
        Some(name) => bail!("joint `{name}` is there twice: give it one position"),
        None => Ok(()),
    }
}

/// A position of a list in words, counted from 1; by its index.
pub fn place(index: usize) -> String {
    format!("position {} of the list", index + 1)
}

fn positions(value: Value) -> Result<Joints> {
    let Value::Object(entries) = value else {
        bail!("not an object of joint names and positions, such as {{\"elbow\": 1.57}}")
    };
    let number = |(name, value): (String, Value)| match value.as_f64() {
        Some(position) => Ok((name, position)),
        None => {
            bail!("joint `{name}` is at {}: give a finite number, in rad or m", as_written(&value))
        }
    };
    entries.into_iter().map(number).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn one_or_many_are_read_and_others_named() {
        assert_eq!(parse(b"{\"a\": 1, \"b\": -0.5}").unwrap()[0]["b"], -0.5);
        assert_eq!(parse(b"[{\"a\": 1}, {\"a\": 2}]").unwrap()[1]["a"], 2.0);
        for (text, parts) in [
            ("[{\"a\": 1}]", vec!["too few positions (1)", "as an object"]),
            (
                "[{\"a\": 1}, {\"a\": NaN}]",
                vec!["position 2 of the list", "`a` is at NaN:", "finite"],
            ),
            ("{\"a\": -Infinity}", vec!["`a` is at -Infinity:"]),
            ("{\"a\": \"1\"}", vec!["`a`", "finite"]),
            // The last of them counted.
            ("{\"a\": 1, \"b\": 2, \"a\": 1}", vec!["`a`", "twice"]),
            (
                "[{\"a\": 1}, {\"a\": 1, \"\\u0061\": 2}]",
                vec!["position 2 of the list", "`a`", "twice"],
            ),
            ("[[1, 2], [3, 4]]", vec!["position 1 of the list", "such as"]),
            ("{\"a\"", vec!["not a JSON object"]),
        ] {
            let error = format!("{:#}", parse(text.as_bytes()).unwrap_err());
            assert!(parts.iter().all(|part| error.contains(part)), "{error}");
        }
    }
}
