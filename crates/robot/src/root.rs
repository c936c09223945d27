//! What a file is, by the element around all of it: readers pass over its name, and over a second one.

use quick_xml::Reader;
use quick_xml::events::Event;

use crate::error::RobotFault;

/// What a file is to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wanted {
    Urdf,
    Srdf,
}

impl Wanted {
    /// What it is called, and what to do where another is given.
    fn given(self) -> (&'static str, &'static str) {
        match self {
            Self::Urdf => ("a URDF", "give the URDF of the robot"),
            Self::Srdf => ("an SRDF", "give the SRDF of the robot"),
        }
    }
}

/// What else is given, by the name of its root in small letters, and what to do about it.
const OTHERS: [(&str, &str, &str); 4] = [
    ("sdf", "an SDF", "convert it, or export the robot anew"),
    ("mujoco", "a model for MuJoCo (MJCF)", "convert it, or export the robot anew"),
    ("html", "a web page", "download the file that the page shows"),
    ("collada", "a mesh (COLLADA)", "give the file that names it"),
];

/// What an SRDF has and a URDF has not.
const OF_SRDF: [&[u8]; 6] = [
    b"disable_collisions",
    b"end_effector",
    b"group",
    b"group_state",
    b"passive_joint",
    b"virtual_joint",
];

/// Refuses what is another kind of file, or two in one; what is not well formed is for its reader to tell.
pub(crate) fn check(text: &str, wanted: Wanted) -> Result<(), RobotFault> {
    let mut reader = Reader::from_str(text);
    let (mut depth, mut roots) = (0_usize, 0_usize);
    let (mut has_links, mut is_srdf) = (false, false);
    loop {
        let Ok(event) = reader.read_event() else { return Ok(()) };
        match &event {
            Event::Start(start) | Event::Empty(start) => {
                let name = start.local_name();
                match depth {
                    0 if roots > 0 => return Err(RobotFault::SecondRoot { root: text_of(&name) }),
                    0 => is_robot(&text_of(&name), wanted)?,
                    1 => {
                        has_links |= name.as_ref() == b"link";
                        is_srdf |= OF_SRDF.contains(&name.as_ref());
                    }
                    _ => {}
                }
                roots += usize::from(depth == 0);
                depth += usize::from(matches!(event, Event::Start(_)));
            }
            Event::End(_) => depth = depth.saturating_sub(1),
            Event::Eof if roots == 0 => {
                return Err(RobotFault::NoRoot { remedy: wanted.given().1 });
            }
            Event::Eof => break,
            _ => {}
        }
    }
    match wanted {
        Wanted::Urdf if is_srdf && !has_links => Err(RobotFault::NotUrdf),
        _ => Ok(()),
    }
}

fn text_of(name: &quick_xml::name::LocalName<'_>) -> String {
    String::from_utf8_lossy(name.as_ref()).into_owned()
}

fn is_robot(root: &str, wanted: Wanted) -> Result<(), RobotFault> {
    if root == "robot" {
        return Ok(());
    }
    let (wanted, give) = wanted.given();
    let other = OTHERS.iter().find(|(name, ..)| root.eq_ignore_ascii_case(name));
    let (found, remedy) =
        other.map_or(("no description of a robot", give), |&(_, found, remedy)| (found, remedy));
    Err(RobotFault::Root { found, root: root.to_owned(), wanted, remedy })
}
