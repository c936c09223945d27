//! Fields of JSON objects: what is wrong with one is told by its name.

use std::collections::BTreeSet;
use std::fmt;
use std::path::PathBuf;

use anyhow::{Result, bail};
use serde::de::{Deserialize, Deserializer, IgnoredAny, MapAccess, Visitor};
use serde_json::Value;

use crate::files::json::as_written;

/// The text that a field holds.
pub(crate) fn text(name: &str, value: Value) -> Result<String> {
    match value {
        Value::String(text) => Ok(text),
        other => bail!("`{name}` is {}: write one string", as_written(&other)),
    }
}

/// The file that a field names. An empty name would be that of the folder.
pub(crate) fn file(name: &str, value: Value) -> Result<PathBuf> {
    // Python writes NaN where a table has nothing, which is a string by now.
    let written = as_written(&value);
    match value {
        Value::String(path) if !path.is_empty() && written.starts_with('"') => Ok(path.into()),
        _ => bail!("`{name}` is {written}: write the path of one file, a string"),
    }
}

/// The names of an object, each as often as it is there: of two with one name the last would count.
pub(crate) struct Names(Vec<String>);

impl Names {
    /// The first name that was there before.
    pub(crate) fn twice(&self) -> Option<&str> {
        let mut known = BTreeSet::new();
        self.0.iter().find(|name| !known.insert(*name)).map(String::as_str)
    }
}

impl<'de> Deserialize<'de> for Names {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Each;
        impl<'de> Visitor<'de> for Each {
            type Value = Names;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a JSON object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Names, A::Error> {
                let mut names = Vec::new();
                while let Some((name, IgnoredAny)) = map.next_entry()? {
                    names.push(name);
                }
                Ok(Names(names))
            }
        }
        deserializer.deserialize_map(Each)
    }
}

/// Refuses an object, given as text, in which a field is twice.
pub(crate) fn check_once(object: &str) -> Result<()> {
    match serde_json::from_str::<Names>(object)?.twice() {
        Some(name) => bail!("`{name}` is there twice: leave one of them out"),
        None => Ok(()),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_list_for_a_path_was_refused_without_the_name_of_the_field() {
        for value in [json!(["a.pcd"]), json!(3), json!(null), json!({"a": 1}), json!("")] {
            let error = file("scene", value.clone()).unwrap_err().to_string();
            assert!(error.starts_with(&format!("`scene` is {value}: ")), "{error}");
        }
        assert_eq!(file("scene", json!("a.pcd")).unwrap(), PathBuf::from("a.pcd"));
        assert!(text("sensor", json!(["iso:0.1"])).unwrap_err().to_string().contains("`sensor`"));
    }

    #[test]
    fn of_two_fields_with_one_name_the_last_counted() {
        let error = check_once(r#"{"a": 1, "b": {"c": 1, "c": 2}, "\u0061": 2}"#).unwrap_err();
        assert_eq!(error.to_string(), "`a` is there twice: leave one of them out");
        assert!(check_once(r#"{"a": 1, "b": [2, 2]}"#).is_ok());
    }
}
