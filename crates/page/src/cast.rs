//! The bodies of a scene on a page: all of them in every view, each where it stands.

use std::borrow::Cow;

use cloudtouch::geom::Point3;
use cloudtouch::{PairAnswer, Scene, SceneError};

use crate::body::{Body, Shape};
use crate::inside::colored;
use crate::view::{Asked, Standing, View};

/// All bodies of a scene, as a page draws them: the largest first, or the one that keeps its place.
#[derive(Debug, Clone)]
pub struct Cast {
    bodies: Vec<Body>,
}

impl Cast {
    /// The bodies of a scene, `first` before the others if there is one of that name; `about` says what each was
    /// taken for.
    ///
    /// # Errors
    /// Never as it stands: all that are asked for are in the scene.
    pub fn of(
        scene: &Scene,
        first: Option<&str>,
        about: impl Fn(&str) -> String,
    ) -> Result<Self, SceneError> {
        let size = |[low, high]: [Point3; 2]| (high - low).norm();
        let boxes = scene.boxes();
        let mut named: Vec<(&str, f64)> =
            boxes.into_iter().map(|(name, corners)| (name, size(corners))).collect();
        let is_first = |name: &str| first == Some(name);
        named.sort_by(|(p, of_p), (q, of_q)| {
            is_first(q).cmp(&is_first(p)).then(of_q.total_cmp(of_p))
        });
        let drawn = |(name, _): (&str, f64)| {
            let shape = Shape::from(&**scene.body(name)?);
            Ok(Body { name: name.to_owned(), about: about(name), shape })
        };
        Ok(Self { bodies: named.into_iter().map(drawn).collect::<Result<_, SceneError>>()? })
    }

    /// The bodies, as views name them by their places.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// The same, for the page.
    #[must_use]
    pub fn into_bodies(self) -> Vec<Body> {
        self.bodies
    }

    /// All of them where they stand in the scene, and nothing that was answered.
    ///
    /// # Errors
    /// When the scene lacks one of them.
    pub fn overview(
        &self,
        scene: &Scene,
        name: impl Into<String>,
    ) -> Result<View<'static>, SceneError> {
        Ok(View::of_all(name, self.standing(scene)?))
    }

    /// Two of them with the answer, and the others around; `None` for a pair without an answer. Points inside of a
    /// closed mesh have a colour too.
    ///
    /// # Errors
    /// When the scene lacks one of them.
    pub fn view(
        &self,
        scene: &Scene,
        name: impl Into<String>,
        pair: &PairAnswer,
    ) -> Result<Option<View<'static>>, SceneError> {
        let mut around = self.standing(scene)?;
        let mut take = |name: &str| {
            let place = around.iter().position(|of| self.bodies[of.body].name == name)?;
            Some(around.remove(place))
        };
        let (scene_of_pair, object) = (take(&pair.a), take(&pair.b));
        let (Some(report), Some(a), Some(b)) = (colored(pair, scene)?, scene_of_pair, object)
        else {
            return Ok(None);
        };
        let report = Cow::Owned(report);
        let asked = Asked { scene: a, object: b, report, placement: None };
        Ok(Some(View { name: name.into(), asked: Some(asked), around, more: Vec::new() }))
    }

    fn standing(&self, scene: &Scene) -> Result<Vec<Standing>, SceneError> {
        let bodies = self.bodies.iter().enumerate();
        bodies.map(|(body, of)| Ok(Standing { body, pose: scene.pose(&of.name)? })).collect()
    }
}
