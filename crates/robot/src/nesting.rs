//! How deep the elements of a file are nested: readers of XML count levels in few bits, or call themselves for each.

use quick_xml::Reader;
use quick_xml::events::Event;

use crate::error::RobotFault;

/// The shapes of a link are five deep.
const DEEPEST: usize = 100;

/// Refuses what no description of a robot is; what is not well formed is for its reader to tell.
pub(crate) fn check(text: &str) -> Result<(), RobotFault> {
    let mut reader = Reader::from_str(text);
    let mut depth = 0_usize;
    loop {
        match reader.read_event() {
            Ok(Event::Start(_)) => depth += 1,
            Ok(Event::End(_)) => depth = depth.saturating_sub(1),
            Ok(Event::Eof) | Err(_) => return Ok(()),
            Ok(_) => {}
        }
        if depth > DEEPEST {
            let reason = format!("elements are nested more than {DEEPEST} deep");
            return Err(RobotFault::Xml { reason });
        }
    }
}
