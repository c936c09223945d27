//! Bodies that move with others.

use cloudtouch_geom::Pose;

use crate::error::SceneError;

use super::bodies::{Placed, Scene, check};

impl Scene {
    /// Attaches a body to another, with which it moves from then on, at a pose from its frame into that
    /// of the other: [`Self::between`] tells the one it has. That the two may touch is not said by it:
    /// [`Self::allow`] does.
    ///
    /// # Errors
    /// When one of them is not in the scene, the other moves with this one already, or the pose is not
    /// finite or beyond 1e10 m.
    pub fn attach(&mut self, name: &str, to: &str, to_from_body: Pose) -> Result<(), SceneError> {
        self.placed(name)?;
        self.placed(to)?;
        check(name, &to_from_body)?;
        if self.carriers(to).any(|(carrier, _)| carrier == name) {
            return Err(SceneError::Circle { name: name.to_owned(), to: to.to_owned() });
        }
        let placed = self.placed_mut(name)?;
        (placed.pose, placed.attached_to) = (to_from_body, Some(to.to_owned()));
        Ok(())
    }

    /// Lets go of a body, which stays where it is.
    ///
    /// # Errors
    /// When there is no body of this name, or it is attached to none.
    pub fn detach(&mut self, name: &str) -> Result<(), SceneError> {
        let here = self.pose(name)?;
        let placed = self.placed_mut(name)?;
        if placed.attached_to.take().is_none() {
            return Err(SceneError::NotAttached { name: name.to_owned() });
        }
        placed.pose = here;
        Ok(())
    }

    /// Where a body is in the scene: from its frame into that of the scene, whatever it is attached to.
    ///
    /// # Errors
    /// When there is no body of this name.
    pub fn pose(&self, name: &str) -> Result<Pose, SceneError> {
        self.placed(name)?;
        let poses = self.carriers(name).map(|(_, placed)| placed.pose);
        Ok(poses.fold(Pose::identity(), |pose, carrier| carrier.after(&pose)))
    }

    /// Where a body is as another sees it: from the frame of `of` into that of `seen_from`.
    ///
    /// # Errors
    /// When one of them is not in the scene.
    pub fn between(&self, seen_from: &str, of: &str) -> Result<Pose, SceneError> {
        Ok(self.pose(seen_from)?.inverse().after(&self.pose(of)?))
    }

    /// A body, what it is attached to, what that is, and so on.
    fn carriers<'a>(&'a self, name: &'a str) -> impl Iterator<Item = (&'a str, &'a Placed)> {
        let of = |name: &'a str| self.bodies.get(name).map(|placed| (name, placed));
        std::iter::successors(of(name), move |(_, placed)| of(placed.attached_to.as_deref()?))
    }
}
