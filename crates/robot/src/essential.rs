//! What of a URDF places and shapes its links.

use quick_xml::events::attributes::Attribute;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, Writer};

use crate::error::RobotFault;

/// Parts that say nothing of where a link is: masses, colours, simulation, drives. Many a file leaves
/// out half of what the schema asks for there.
const PASSED_OVER: [&[u8]; 8] = [
    b"inertial",
    b"material",
    b"gazebo",
    b"transmission",
    b"ros2_control",
    b"dynamics",
    b"calibration",
    b"safety_controller",
];

/// What is read, with all its attributes where one that is not read may misplace a link or its shape.
const ELEMENTS: [(&str, &[&str]); 16] = [
    ("robot", &[]),
    ("link", &[]),
    ("joint", &[]),
    ("collision", &[]),
    ("visual", &[]),
    ("geometry", &[]),
    ("parent", &[]),
    ("child", &[]),
    ("origin", &["xyz", "rpy"]),
    // Some exporters write a turn of the axis, which no reader takes.
    ("axis", &["xyz", "rpy"]),
    ("limit", &[]),
    ("mimic", &["joint", "multiplier", "offset"]),
    ("mesh", &["filename", "scale"]),
    ("box", &["size"]),
    ("cylinder", &["radius", "length"]),
    ("sphere", &["radius"]),
];

/// Attributes that are numbers, of which readers pass over what is none.
const NUMBERS: [&str; 4] = ["xyz", "rpy", "size", "scale"];

/// The text of a URDF without these parts, and without what belongs to the namespaces of others.
pub(crate) fn essential(text: &str) -> Result<String, RobotFault> {
    let fault = |reason: String| RobotFault::Xml { reason };
    let mut reader = Reader::from_str(text);
    let mut writer = Writer::new(Vec::new());
    loop {
        let event = reader.read_event().map_err(|error| fault(error.to_string()))?;
        let kept = match event {
            Event::Eof => break,
            Event::Start(start) if is_passed_over(&start)? => {
                let to_end = reader.read_to_end(start.name());
                to_end.map_err(|error| fault(error.to_string()))?;
                continue;
            }
            Event::Empty(start) if is_passed_over(&start)? => continue,
            Event::Start(start) => Event::Start(plain(&known(start)?)?),
            Event::Empty(start) => Event::Empty(plain(&known(start)?)?),
            other => other,
        };
        writer.write_event(kept).map_err(|error| fault(error.to_string()))?;
    }
    String::from_utf8(writer.into_inner()).map_err(|error| fault(error.to_string()))
}

fn is_passed_over(start: &BytesStart<'_>) -> Result<bool, RobotFault> {
    let name = start.name();
    match name.prefix() {
        // Its links and joints are not there yet: the rest is not the robot.
        Some(prefix) if prefix.as_ref() == b"xacro" => {
            let name = String::from_utf8_lossy(name.as_ref()).into_owned();
            Err(RobotFault::Xml { reason: format!("<{name}> is not expanded") })
        }
        prefix => Ok(prefix.is_some() || PASSED_OVER.contains(&name.as_ref())),
    }
}

/// The same, unless its name or that of an attribute is a slip: what places a link would be passed over.
fn known(start: BytesStart<'_>) -> Result<BytesStart<'_>, RobotFault> {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let name = text(start.name().as_ref());
    let fault = |reason: String| Err(RobotFault::Xml { reason });
    let Some((_, attributes)) = ELEMENTS.iter().find(|(known, _)| *known == name) else {
        let is_meant = |known: &str| {
            name.eq_ignore_ascii_case(known) || strsim::damerau_levenshtein(&name, known) == 1
        };
        return match ELEMENTS.iter().find(|(known, _)| is_meant(known)) {
            Some((known, _)) => fault(format!("<{name}> is not known: write <{known}>")),
            None => Ok(start),
        };
    };
    for attribute in own_attributes(&start)? {
        let own = text(attribute.key.as_ref());
        if !attributes.is_empty()
            && !attributes.contains(&own.as_str())
            && !own.starts_with("xmlns")
        {
            let known = attributes.join(" or ");
            return fault(format!("`{own}` of <{name}> is not known: write {known}"));
        }
        let value = text(&attribute.value);
        let is_number = |word: &&str| word.parse::<f64>().is_ok();
        if NUMBERS.contains(&own.as_str())
            && let Some(word) = value.split_whitespace().find(|word| !is_number(word))
        {
            return fault(format!("`{own}` of <{name}> is `{value}`: `{word}` is not a number"));
        }
    }
    Ok(start)
}

/// The attributes that are of no other namespace.
fn own_attributes<'a>(start: &'a BytesStart<'_>) -> Result<Vec<Attribute<'a>>, RobotFault> {
    let fault = |error: &dyn std::fmt::Display| {
        let name = String::from_utf8_lossy(start.name().as_ref()).into_owned();
        RobotFault::Xml { reason: format!("the attributes of <{name}>: {error}") }
    };
    let all: Result<Vec<_>, _> = start.attributes().collect();
    let mut all = all.map_err(|error| fault(&error))?;
    all.retain(|attribute| attribute.key.prefix().is_none());
    Ok(all)
}

/// Without attributes of other namespaces, such as a comment of xacro. How fast a joint may move, which
/// the schema asks for and many leave out, is not asked about.
fn plain(start: &BytesStart<'_>) -> Result<BytesStart<'static>, RobotFault> {
    let mut kept = start.to_owned();
    kept.clear_attributes();
    kept.extend_attributes(own_attributes(start)?);
    if kept.name().as_ref() == b"limit" && matches!(kept.try_get_attribute("velocity"), Ok(None)) {
        kept.push_attribute(("velocity", "0"));
    }
    Ok(kept.into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

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
            // What is not well formed, or no number, was passed over: no turn, and up for down.
            ("<origin xyz='0 0 1' rpy=1.57/>", "the attributes of <origin>"),
            ("<origin xyz='0 0 0' xyz='0 0 1'/>", "the attributes of <origin>"),
            ("<origin xyz='0 0 - 0.5'/>", "`xyz` of <origin> is `0 0 - 0.5`: `-` is not a number"),
            ("<geometry><box size='1 2 3mm 4'/></geometry>", "`3mm` is not a number"),
        ] {
            let error = within(inner).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
        assert!(within("<origin xyz='0 0 1'/><contact_coefficients mu='1'/>").is_ok());
    }

    #[test]
    fn what_places_nothing_is_passed_over_and_an_unexpanded_file_refused() {
        let text = "<robot xmlns:x='http://x' name='a'><link name='b' x:c='1'><inertial><mass/></inertial>\
                    <collision/></link><x:d><link name='e'/></x:d><gazebo/></robot>";
        let kept = essential(text).unwrap().replace('\"', "'");
        assert_eq!(kept, "<robot name='a'><link name='b'><collision/></link></robot>");
        let error = essential("<robot><xacro:arm name='a'/></robot>").unwrap_err().to_string();
        assert!(
            error.contains("<xacro:arm> is not expanded") && error.contains("arm.urdf"),
            "{error}"
        );
    }
}
