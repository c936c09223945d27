//! Which links may touch, by an SRDF.

use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::at_fault;
use crate::error::RobotFault;
use crate::nesting;
use crate::root::{self, Wanted};

#[derive(Deserialize)]
struct Srdf {
    #[serde(rename = "disable_collisions", default)]
    disabled: Vec<Disabled>,
    /// A URDF has these.
    #[serde(rename = "link", default)]
    links: Vec<IgnoredAny>,
}

#[derive(Deserialize)]
struct Disabled {
    #[serde(rename = "@link1")]
    link1: String,
    #[serde(rename = "@link2")]
    link2: String,
}

/// The pairs of links that an SRDF says not to check. What else it says (groups, poses, defaults to
/// disable) is passed over, which leaves more to be checked, never less.
pub(crate) fn disabled_pairs(text: &str) -> Result<Vec<[String; 2]>, RobotFault> {
    if text.trim().is_empty() {
        return Err(RobotFault::Empty);
    }
    nesting::check(text)?;
    root::check(text, Wanted::Srdf)?;
    let read = |text: &str| -> Result<Srdf, RobotFault> {
        quick_xml::de::from_str(text).map_err(|error| RobotFault::Xml { reason: error.to_string() })
    };
    let srdf =
        read(text).map_err(|fault| at_fault::named(fault, text, |alone| read(alone).err()))?;
    if srdf.disabled.is_empty() && !srdf.links.is_empty() {
        return Err(RobotFault::NotSrdf);
    }
    Ok(srdf.disabled.into_iter().map(|pair| [pair.link1, pair.link2]).collect())
}
