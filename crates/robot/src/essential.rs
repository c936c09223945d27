//! What of a URDF places and shapes its links.

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, Writer};

use crate::error::RobotFault;
use crate::places;
use crate::slips::{known, own_attributes};

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

/// What other namespaces have no use for: some programs write a prefix before every element.
const OF_THE_ROBOT: [&[u8]; 3] = [b"robot", b"link", b"collision"];

/// The text of a URDF without these parts, and without what belongs to the namespaces of others.
pub(crate) fn essential(text: &str) -> Result<String, RobotFault> {
    let fault = |reason: String| RobotFault::Xml { reason };
    let mut reader = Reader::from_str(text);
    let mut writer = Writer::new(Vec::new());
    let mut open: Vec<String> = Vec::new();
    // Whether nothing is in the innermost of them so far.
    let mut is_bare = false;
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
            Event::Start(start) => {
                let name = read_in(&start, &open, is_bare)?;
                open.push(name);
                is_bare = true;
                Event::Start(plain(&known(start)?)?)
            }
            Event::Empty(start) => {
                let name = read_in(&start, &open, is_bare)?;
                check_shape(&name, true)?;
                is_bare = false;
                Event::Empty(plain(&known(start)?)?)
            }
            Event::End(end) => {
                let name = open.pop();
                check_shape(name.as_deref().unwrap_or_default(), is_bare)?;
                is_bare = false;
                Event::End(end)
            }
            other => other,
        };
        writer.write_event(kept).map_err(|error| fault(error.to_string()))?;
    }
    String::from_utf8(writer.into_inner()).map_err(|error| fault(error.to_string()))
}

/// The name of an element, where it is read in the innermost of those that are open, in which nothing may be so far.
fn read_in(start: &BytesStart<'_>, open: &[String], is_bare: bool) -> Result<String, RobotFault> {
    let name = String::from_utf8_lossy(start.name().as_ref()).into_owned();
    let around = open.last().map(String::as_str);
    places::check(&name, around)?;
    if around == Some("geometry") && !is_bare {
        let reason =
            format!("<{name}> is a second shape in <geometry>: give each a <collision> of its own");
        return Err(RobotFault::Xml { reason });
    }
    Ok(name)
}

/// Refuses a geometry of nothing, of which readers say nothing that helps.
fn check_shape(name: &str, is_bare: bool) -> Result<(), RobotFault> {
    if name == "geometry" && is_bare {
        let reason =
            "<geometry> is empty: put a <mesh>, <box>, <cylinder>, <capsule> or <sphere> into it";
        return Err(RobotFault::Xml { reason: reason.to_owned() });
    }
    Ok(())
}

fn is_passed_over(start: &BytesStart<'_>) -> Result<bool, RobotFault> {
    let name = start.name();
    if PASSED_OVER.contains(&name.as_ref()) {
        return Ok(true);
    }
    let prefix = name.prefix();
    // Links and joints are elsewhere yet: the rest is not the robot.
    if prefix.is_some_and(|prefix| prefix.as_ref() == b"xacro")
        || name.local_name().as_ref() == b"include"
    {
        let name = String::from_utf8_lossy(name.as_ref()).into_owned();
        return Err(RobotFault::Xml { reason: format!("<{name}> is not expanded") });
    }
    if prefix.is_some() && OF_THE_ROBOT.contains(&name.local_name().as_ref()) {
        let [name, own] = [name.as_ref(), name.local_name().into_inner()]
            .map(|name| String::from_utf8_lossy(name).into_owned());
        let reason =
            format!("<{name}> has a prefix, by which it is no part of the robot: write <{own}>");
        return Err(RobotFault::Xml { reason });
    }
    Ok(prefix.is_some())
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
