//! The elements of a URDF that are read.

/// One of them.
pub(crate) struct Element {
    pub name: &'static str,
    /// What it is read in; nothing is around all of the file.
    pub places: &'static [&'static str],
    /// All its attributes, where one that is not read may misplace a link or its shape; else none.
    pub attributes: &'static [&'static str],
}

const fn element(
    name: &'static str,
    places: &'static [&'static str],
    attributes: &'static [&'static str],
) -> Element {
    Element { name, places, attributes }
}

/// All of them.
static ELEMENTS: [Element; 17] = [
    element("robot", &[], &[]),
    element("link", &["robot"], &[]),
    element("joint", &["robot"], &[]),
    element("collision", &["link"], &[]),
    element("visual", &["link"], &[]),
    element("geometry", &["collision", "visual"], &[]),
    element("parent", &["joint"], &[]),
    element("child", &["joint"], &[]),
    // Some write one in a link, where the standard has none.
    element("origin", &["collision", "visual", "joint", "link"], &["xyz", "rpy"]),
    // Some exporters write a turn of the axis, which no reader takes.
    element("axis", &["joint"], &["xyz", "rpy"]),
    element("limit", &["joint"], &[]),
    element("mimic", &["joint"], &["joint", "multiplier", "offset"]),
    element("mesh", &["geometry"], &["filename", "scale"]),
    element("box", &["geometry"], &["size"]),
    element("cylinder", &["geometry"], &["radius", "length"]),
    element("capsule", &["geometry"], &["radius", "length"]),
    element("sphere", &["geometry"], &["radius"]),
];

/// The element of a name.
pub(crate) fn named(name: &str) -> Option<&'static Element> {
    such_that(|known| known == name)
}

/// The first element of such a name.
pub(crate) fn such_that(is_one: impl Fn(&str) -> bool) -> Option<&'static Element> {
    ELEMENTS.iter().find(|element| is_one(element.name))
}
