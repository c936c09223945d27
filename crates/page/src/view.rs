//! What is shown at a time.

use std::borrow::Cow;

use cloudtouch::geom::Pose;
use cloudtouch::{Placement, Report};

use crate::fact::Fact;

/// Where bodies are, and what was answered about two of them.
#[derive(Debug, Clone)]
pub struct View<'a> {
    /// Such as the name of the case.
    pub name: String,
    /// The two that were asked about, if any.
    pub asked: Option<Asked<'a>>,
    /// What else is drawn.
    pub around: Vec<Standing>,
    /// What else is to be said of it, after what the report tells.
    pub more: Vec<Fact>,
}

/// An object in a scene, and the answer.
#[derive(Debug, Clone)]
pub struct Asked<'a> {
    /// A of the report.
    pub scene: Standing,
    /// B of the report.
    pub object: Standing,
    /// The answer, of which all but times is told; its contacts are in the frame of the picture.
    pub report: Cow<'a, Report>,
    /// Where the object lies in the scene, if that was asked.
    pub placement: Option<&'a Placement>,
}

/// One of the page's bodies, where it stands.
#[derive(Debug, Clone, Copy)]
pub struct Standing {
    /// Its place in the list of the page.
    pub body: usize,
    /// Maps it into the frame of the picture.
    pub pose: Pose,
}

impl<'a> View<'a> {
    /// An object in a scene, whose frame is that of the picture.
    pub fn of_pair(
        name: impl Into<String>,
        [scene, object]: [usize; 2],
        scene_from_object: Pose,
        report: &'a Report,
    ) -> Self {
        let scene = Standing { body: scene, pose: Pose::identity() };
        let object = Standing { body: object, pose: scene_from_object };
        let asked = Asked { scene, object, report: Cow::Borrowed(report), placement: None };
        Self { name: name.into(), asked: Some(asked), around: Vec::new(), more: Vec::new() }
    }

    /// Bodies of which nothing was answered.
    pub fn of_all(name: impl Into<String>, around: Vec<Standing>) -> Self {
        Self { name: name.into(), asked: None, around, more: Vec::new() }
    }

    /// The same, telling where the object lies in the scene.
    #[must_use]
    pub fn with_placement(mut self, placement: &'a Placement) -> Self {
        if let Some(asked) = &mut self.asked {
            asked.placement = Some(placement);
        }
        self
    }

    /// The same, with more to be said of it.
    #[must_use]
    pub fn with_more(self, more: Vec<Fact>) -> Self {
        Self { more, ..self }
    }

    /// The two that were asked about, scene and object.
    pub(crate) fn pair(&self) -> Option<[Standing; 2]> {
        self.asked.as_ref().map(|asked| [asked.scene, asked.object])
    }

    /// All that is drawn.
    pub(crate) fn standing(&self) -> impl Iterator<Item = Standing> {
        self.pair().into_iter().flatten().chain(self.around.iter().copied())
    }
}
