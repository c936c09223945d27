//! One pose with its answer.

use cloudtouch::geom::Pose;
use cloudtouch::{Placement, Report};

use crate::fact::Fact;

/// An object in a scene at one pose.
#[derive(Debug, Clone)]
pub struct View<'a> {
    /// Such as the name of the case.
    pub name: String,
    /// Which of the page's bodies is the scene.
    pub scene: usize,
    /// Which of them is the object.
    pub object: usize,
    /// Maps the object into the scene.
    pub scene_from_object: Pose,
    /// The answer, of which all but times is told.
    pub report: &'a Report,
    /// Where the object lies in the scene, if that was asked.
    pub placement: Option<&'a Placement>,
    /// What else is to be said of it, after what the report tells.
    pub more: Vec<Fact>,
}
