//! Which link or joint of a URDF, or which pair of an SRDF, cannot be read, and in which line: what their readers say
//! tells neither.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use crate::error::RobotFault;

/// The same fault, with the first element of the robot that has it when read alone. `fault_of` reads a text.
pub(crate) fn named(
    fault: RobotFault,
    text: &str,
    fault_of: impl Fn(&str) -> Option<RobotFault>,
) -> RobotFault {
    let RobotFault::Xml { reason } = fault else { return fault };
    let has_it = |alone: &str| matches!(fault_of(alone), Some(RobotFault::Xml { reason: of_it }) if of_it == reason);
    match first(text, has_it) {
        Some(place) => RobotFault::Xml { reason: format!("{place}: {reason}") },
        None => RobotFault::Xml { reason },
    }
}

/// The first element in the root of which this holds, with the root around it alone; or the one that no reader gets
/// to the end of.
fn first(text: &str, holds: impl Fn(&str) -> bool) -> Option<String> {
    let mut reader = Reader::from_str(text);
    let (mut root, mut depth) = (String::new(), 0_usize);
    let mut element = String::new();
    let mut start = 0;
    loop {
        let before = usize::try_from(reader.buffer_position()).ok()?;
        let Ok(event) = reader.read_event() else {
            let at = usize::try_from(reader.error_position()).ok()?;
            let within = if depth > 1 { format!("{element}, ") } else { String::new() };
            return Some(format!("{within}line {}", line(text, at)?));
        };
        let after = usize::try_from(reader.buffer_position()).ok()?;
        match &event {
            Event::Start(tag) | Event::Empty(tag) if depth == 1 => {
                (element, start) = (told(tag), before);
            }
            Event::Start(_) if depth == 0 => text.get(before..after)?.clone_into(&mut root),
            Event::Eof if depth > 1 => return Some(format!("{element}, where the file ends")),
            Event::Eof if depth > 0 => return Some("the file ends before </robot>".to_owned()),
            Event::Eof => return None,
            _ => {}
        }
        match &event {
            Event::Start(_) => depth += 1,
            Event::End(_) => depth = depth.saturating_sub(1),
            _ => {}
        }
        let is_whole = depth == 1 && matches!(event, Event::End(_) | Event::Empty(_));
        if is_whole && holds(&format!("{root}{}</robot>", text.get(start..after)?)) {
            return Some(format!("{element}, line {}", line(text, start)?));
        }
    }
}

fn told(tag: &BytesStart<'_>) -> String {
    let kind = String::from_utf8_lossy(tag.name().as_ref()).into_owned();
    let name = tag.try_get_attribute("name").ok().flatten();
    match name {
        Some(name) => format!("{kind} `{}`", String::from_utf8_lossy(&name.value)),
        None => format!("<{kind}>"),
    }
}

/// Counted from 1.
fn line(text: &str, at: usize) -> Option<usize> {
    Some(1 + text.get(..at)?.matches('\n').count())
}
