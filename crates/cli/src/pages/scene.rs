//! The report page of a scene, or of a robot at one position.

use std::path::Path;

use anyhow::Result;
use cloudtouch::{Checked, Scene};
use cloudtouch_page::{Cast, Fact, Page};

use crate::answers::scene::{place, warnings};
use crate::pages;

/// Writes a page of what was found; `first` keeps its place, else the largest does; `taken_for` says what each body
/// is.
pub(crate) fn write(
    output: &Path,
    (scene, checked): (&Scene, &Checked),
    first: Option<&str>,
    (title, facts): (String, Vec<Fact>),
    taken_for: impl Fn(&str) -> String,
) -> Result<()> {
    let cast = cast(scene, first, taken_for)?;
    let mut page = Page { title, ..Page::of_scene(cast, scene, checked)? };
    page.summary.extend(facts);
    page.summary.extend(doubts(checked));
    pages::write(output, page)
}

/// The bodies of a scene, each with what it was taken for and where it is.
pub(super) fn cast(
    scene: &Scene,
    first: Option<&str>,
    taken_for: impl Fn(&str) -> String,
) -> Result<Cast> {
    let boxes = scene.boxes();
    let about = |name: &str| {
        let parts = [Some(taken_for(name)), boxes.get(name).map(place)];
        let parts: Vec<String> = parts.into_iter().flatten().filter(|of| !of.is_empty()).collect();
        parts.join(", ")
    };
    Ok(Cast::of(scene, first, about)?)
}

/// What is to be said of bodies by themselves.
pub(super) fn doubts(checked: &Checked) -> impl Iterator<Item = Fact> {
    warnings(checked).map(|words| Fact::new("Warning", words))
}
