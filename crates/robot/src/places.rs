//! Where the elements of a URDF belong: readers pass over those that are elsewhere, and their shapes with them.

use crate::error::RobotFault;

/// Elements that are read, and what they are read in.
const PLACES: [(&str, &[&str]); 16] = [
    ("link", &["robot"]),
    ("joint", &["robot"]),
    ("collision", &["link"]),
    ("visual", &["link"]),
    ("geometry", &["collision", "visual"]),
    ("mesh", &["geometry"]),
    ("box", &["geometry"]),
    ("cylinder", &["geometry"]),
    ("capsule", &["geometry"]),
    ("sphere", &["geometry"]),
    ("parent", &["joint"]),
    ("child", &["joint"]),
    ("axis", &["joint"]),
    ("limit", &["joint"]),
    ("mimic", &["joint"]),
    // Some write one in a link, where the standard has none.
    ("origin", &["collision", "visual", "joint", "link"]),
];

/// Refuses an element that would be passed over. What else is in a file has parts of its own by these names, such
/// as the `<parent>` of a `<sensor>`.
pub(crate) fn check(name: &str, around: Option<&str>) -> Result<(), RobotFault> {
    let is_read = |name: &str| name == "robot" || PLACES.iter().any(|(known, _)| *known == name);
    let Some(around) = around.filter(|around| is_read(around)) else { return Ok(()) };
    match PLACES.iter().find(|(known, _)| *known == name) {
        Some((_, places)) if !places.contains(&around) => {
            let places: Vec<String> = places.iter().map(|place| format!("<{place}>")).collect();
            let reason = format!(
                "<{name}> is in <{around}>, where it is not read: put it into {}",
                places.join(" or ")
            );
            Err(RobotFault::Xml { reason })
        }
        _ => Ok(()),
    }
}
