//! What a robot holds, and what may touch.

use std::sync::Arc;

use cloudtouch::geom::Pose;
use cloudtouch::{Body, SceneError};

use crate::carried::Carried;
use crate::checker::{RobotChecker, SURROUNDINGS};

impl RobotChecker {
    /// Attaches a body to a link at `link_from_body`, a pose from its file frame into that of the link: from then on
    /// it moves with the link, along paths too, and is asked about as the links are, but beside what holds it.
    ///
    /// The surroundings must not hold it any more. Other links that touch it, such as fingers, have to be
    /// [allowed](Self::allow) with [`Touching::AndItself`](crate::Touching::AndItself).
    ///
    /// # Errors
    /// When no link has that name, something else has the name of the body, or the pose is not finite.
    pub fn hold(
        &mut self,
        name: &str,
        body: impl Into<Arc<Body>>,
        link: &str,
        link_from_body: Pose,
    ) -> Result<(), SceneError> {
        let place = self.robot.tree.links.iter().position(|known| known == link);
        let place = place.ok_or_else(|| SceneError::UnknownName { name: link.to_owned() })?;
        // Some links are in the scene by other names, one for each of their shapes, or not at all.
        if self.robot.tree.links.iter().any(|known| known == name) {
            return Err(SceneError::NameTaken { name: name.to_owned() });
        }
        let body = body.into();
        self.scene.add(name, Arc::clone(&body), link_from_body)?;
        self.carried.push(Carried::held(name.to_owned(), place, link_from_body, body));
        self.allow_what_may_touch(self.carried.len() - 1)
    }

    /// Lets go of a body that is held, and returns it.
    ///
    /// # Errors
    /// When nothing of that name is held.
    pub fn release(&mut self, name: &str) -> Result<Arc<Body>, SceneError> {
        let is_it = |part: &Carried| !part.is_shape && part.name == name;
        let Some(place) = self.carried.iter().position(is_it) else {
            return Err(SceneError::UnknownName { name: name.to_owned() });
        };
        self.carried.remove(place);
        self.scene.remove(name)
    }

    /// Says that two may touch, each a link, what is held, or the [`SURROUNDINGS`]: a base and the table that it is
    /// bolted to, or what no camera sees around it; a finger and what it holds. They are not asked about.
    ///
    /// A link that has no shape is asked about no pair, whether it may touch or not.
    ///
    /// # Errors
    /// When one of them is neither a link nor held.
    pub fn allow(&mut self, a: &str, b: &str) -> Result<(), SceneError> {
        let [of_a, of_b] = [self.bodies_of(a)?, self.bodies_of(b)?];
        let pairs = of_a.iter().flat_map(|a| of_b.iter().map(move |b| (a, b)));
        pairs.into_iter().try_for_each(|(a, b)| self.scene.allow(a, b))
    }

    /// Names in the scene of all shapes of a link, or of what has that name itself.
    fn bodies_of(&self, name: &str) -> Result<Vec<String>, SceneError> {
        if name == SURROUNDINGS {
            return Ok(vec![name.to_owned()]);
        }
        let is_it = |part: &&Carried| match part.is_shape {
            true => self.robot.tree.links[part.link] == name,
            false => part.name == name,
        };
        let names: Vec<String> =
            self.carried.iter().filter(is_it).map(|part| part.name.clone()).collect();
        if names.is_empty() && !self.robot.tree.links.iter().any(|link| link == name) {
            return Err(SceneError::UnknownName { name: name.to_owned() });
        }
        Ok(names)
    }
}
