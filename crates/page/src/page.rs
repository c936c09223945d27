//! What a page shows.

use cloudtouch::Warning;

use crate::body::Body;
use crate::fact::Fact;
use crate::view::View;

/// Bodies and the poses in which they were asked about.
#[derive(Debug, Clone, Default)]
pub struct Page<'a> {
    /// What it is about, such as the names of two files.
    pub title: String,
    /// What is true of all views together, such as of a path.
    pub summary: Vec<Fact>,
    /// What is to be said of the page itself, such as which poses it leaves out.
    pub notes: Vec<String>,
    /// Scenes and objects, which the views name by their place in this list.
    pub bodies: Vec<Body>,
    /// Poses with their answers, in the order of the slider.
    pub views: Vec<View<'a>>,
    /// Which of them is shown first.
    pub start: usize,
    /// Whether all views are of one scene in one frame, the first body at one place in each of them: the picture
    /// stays where it is from view to view. Else that is so of views that have the same scene.
    pub is_one_scene: bool,
    /// By what those who read the page do what a warning asks for, such as an option: told behind it.
    pub remedy: Option<fn(&Warning) -> Option<&'static str>>,
}
