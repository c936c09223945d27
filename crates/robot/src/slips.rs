//! Slips in what places and shapes the links of a URDF: readers pass over what they do not know.

use quick_xml::events::BytesStart;
use quick_xml::events::attributes::Attribute;

use crate::elements::{named, such_that};
use crate::error::RobotFault;

/// What of `<limit>` is read, and what else is written for it, in small letters. Other attributes are passed over:
/// some drives have more of them.
const RANGE: [(&str, &[&str]); 2] = [
    ("lower", &["min", "minimum", "low", "lower_limit", "lower_bound"]),
    ("upper", &["max", "maximum", "high", "upper_limit", "upper_bound"]),
];

/// Attributes that are numbers, and how many: readers pass over what is none, or name neither element nor attribute.
const NUMBERS: [(&str, usize); 10] = [
    ("xyz", 3),
    ("rpy", 3),
    ("size", 3),
    ("scale", 3),
    ("radius", 1),
    ("length", 1),
    ("lower", 1),
    ("upper", 1),
    ("multiplier", 1),
    ("offset", 1),
];

/// What else is read.
const READ: [&str; 5] = ["name", "type", "link", "joint", "filename"];

/// The same, unless its name or that of an attribute is a slip: what places a link would be passed over.
pub(crate) fn known(start: BytesStart<'_>) -> Result<BytesStart<'_>, RobotFault> {
    let name = text(start.name().as_ref());
    let fault = |reason: String| Err(RobotFault::Xml { reason });
    let Some(element) = named(&name) else {
        return match such_that(|known| is_meant(&name, known)) {
            Some(meant) => fault(format!("<{name}> is not known: write <{}>", meant.name)),
            None => Ok(start),
        };
    };
    check_prefixes(&start)?;
    let attributes = element.attributes;
    for attribute in own_attributes(&start)? {
        let (own, value) = (text(attribute.key.as_ref()), text(&attribute.value));
        let instead = if name == "limit" {
            meant_of_limit(&own).map(str::to_owned)
        } else {
            let is_known = attributes.is_empty() || attributes.contains(&own.as_str());
            (!is_known && !own.starts_with("xmlns")).then(|| attributes.join(" or "))
        };
        if let Some(instead) = instead {
            return fault(format!("`{own}` of <{name}> is not known: write {instead}"));
        }
        let Some((_, count)) = NUMBERS.iter().find(|(known, _)| *known == own) else { continue };
        let words: Vec<&str> = value.split_whitespace().collect();
        if let Some(word) = words.iter().find(|word| word.parse::<f64>().is_err()) {
            let reason = format!(
                "`{own}` of <{name}> is `{value}`: `{word}` is not a number; spaces are between numbers"
            );
            return fault(reason);
        }
        if words.len() != *count {
            let numbers = if *count == 1 { "number" } else { "numbers" };
            return fault(format!("`{own}` of <{name}> is `{value}`: give {count} {numbers}"));
        }
    }
    Ok(start)
}

/// Refuses an attribute that is read where it has no prefix: it would be passed over.
fn check_prefixes(start: &BytesStart<'_>) -> Result<(), RobotFault> {
    for attribute in start.attributes().flatten() {
        let (prefix, local) = (attribute.key.prefix(), text(attribute.key.local_name().as_ref()));
        let is_read = local.is_empty()
            || READ.contains(&local.as_str())
            || NUMBERS.iter().any(|(known, _)| *known == local);
        if is_read && prefix.is_some_and(|prefix| prefix.as_ref() != b"xmlns") {
            let [own, name] = [attribute.key.as_ref(), start.name().as_ref()].map(text);
            let reason = format!(
                "`{own}` of <{name}> has a prefix, by which it is not read: write it without `:`"
            );
            return Err(RobotFault::Xml { reason });
        }
    }
    Ok(())
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Whether a name that is not known is another one, with a slip.
fn is_meant(name: &str, known: &str) -> bool {
    name.eq_ignore_ascii_case(known)
        || strsim::damerau_levenshtein(&name.to_ascii_lowercase(), known) == 1
}

/// What is meant by an attribute of `<limit>` that is not read, where that is an end of the range.
fn meant_of_limit(own: &str) -> Option<&'static str> {
    let small = own.to_ascii_lowercase();
    let is_slip = |&&(known, others): &&(&str, &[&str])| {
        own != known && (is_meant(own, known) || others.contains(&small.as_str()))
    };
    RANGE.iter().find(is_slip).map(|(known, _)| *known)
}

/// The attributes that are of no other namespace.
pub(crate) fn own_attributes<'a>(
    start: &'a BytesStart<'_>,
) -> Result<Vec<Attribute<'a>>, RobotFault> {
    let fault = |error: &dyn std::fmt::Display| {
        let name = String::from_utf8_lossy(start.name().as_ref()).into_owned();
        RobotFault::Xml { reason: format!("the attributes of <{name}>: {error}") }
    };
    let all: Result<Vec<_>, _> = start.attributes().collect();
    let mut all = all.map_err(|error| fault(&error))?;
    all.retain(|attribute| attribute.key.prefix().is_none());
    Ok(all)
}

#[cfg(test)]
mod tests {
    use crate::essential::essential;

    /// A link with its place misspelt was where its joint is, without a word.
    #[test]
    fn slips_in_what_places_a_link_are_refused() {
        let within = |inner: &str| {
            let text = format!(
                "<robot name='a'><link name='b'><collision>{inner}</collision></link></robot>"
            );
            essential(&text).map_err(|error| error.to_string())
        };
        for (inner, told) in [
            (
                "<origin xyz='0 0 1' rpi='0 0 0'/>",
                "`rpi` of <origin> is not known: write xyz or rpy",
            ),
            ("<origin quat_xyzw='0 0 1 0'/>", "`quat_xyzw` of <origin>"),
            ("<orgin xyz='0 0 1'/>", "<orgin> is not known: write <origin>"),
            ("<Origin xyz='0 0 1'/>", "write <origin>"),
            ("<geometry><mesh filename='a' Scale='1 1 1'/></geometry>", "`Scale` of <mesh>"),
            // With a prefix they were passed over, and the shape was elsewhere.
            (
                "<origin u:xyz='0 0.1 0.2' rpy='0 0 1'/>",
                "`u:xyz` of <origin> has a prefix, by which it is not read",
            ),
            ("<origin xyz:='0 0.1 0.2'/>", "`xyz:` of <origin> has a prefix"),
            ("<geometry><mesh filename='a' u:scale='1 1 2'/></geometry>", "`u:scale` of <mesh>"),
            // What is not well formed, or no number, was passed over: no turn, and up for down.
            ("<origin xyz='0 0 1' rpy=1.57/>", "the attributes of <origin>"),
            ("<origin xyz='0 0 0' xyz='0 0 1'/>", "the attributes of <origin>"),
            ("<origin xyz='0 0 - 0.5'/>", "`xyz` of <origin> is `0 0 - 0.5`: `-` is not a number"),
            ("<geometry><box size='1 2 3mm 4'/></geometry>", "`3mm` is not a number"),
        ] {
            let error = within(inner).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
        let limit = "<robot name='a'><joint><limit loweru:='-1.5' upper='1'/></joint></robot>";
        let error = essential(limit).unwrap_err().to_string();
        assert!(error.contains("`loweru:` of <limit> has a prefix"), "{error}");
        assert!(
            within("<origin xyz='0 0 1' xmlns:size='x' u:note='1'/><contact_coefficients mu='1'/>")
                .is_ok()
        );
    }
}
