//! Where the elements of a URDF belong: readers pass over those that are elsewhere, and their shapes with them.

use crate::elements::named;
use crate::error::RobotFault;

/// Refuses an element that would be passed over. What else is in a file has parts of its own by these names, such
/// as the `<parent>` of a `<sensor>`.
pub(crate) fn check(name: &str, around: Option<&str>) -> Result<(), RobotFault> {
    let (Some(around), Some(element)) = (around.and_then(named), named(name)) else {
        return Ok(());
    };
    if element.places.is_empty() || element.places.contains(&around.name) {
        return Ok(());
    }
    let places: Vec<String> = element.places.iter().map(|place| format!("<{place}>")).collect();
    let reason = format!(
        "<{name}> is in <{}>, where it is not read: put it into {}",
        around.name,
        places.join(" or ")
    );
    Err(RobotFault::Xml { reason })
}
