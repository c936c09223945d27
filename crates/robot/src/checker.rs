//! A robot in its surroundings.

use std::collections::BTreeMap;
use std::sync::Arc;

use cloudtouch::geom::{Point3, Pose};
use cloudtouch::{Body, Checked, Query, Scene, SceneError};

use crate::carried::Carried;
use crate::error::JointsError;
use crate::robot::Robot;

/// Name of the surroundings among the bodies of an answer.
pub const SURROUNDINGS: &str = "surroundings";

/// Which pairs are asked about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Touching {
    /// Every link with the surroundings.
    #[default]
    Surroundings,
    /// Also every link with every other, but those that [may touch](Robot::may_touch).
    AndItself,
}

/// A robot in its surroundings, asked about its joints.
#[derive(Debug, Clone)]
pub struct RobotChecker {
    pub(crate) robot: Arc<Robot>,
    pub(crate) scene: Scene,
    /// The shapes of the links, and after these what they hold.
    pub(crate) carried: Vec<Carried>,
    pub(crate) scene_from_base: Pose,
    pub(crate) touching: Touching,
}

impl RobotChecker {
    /// Puts a robot into a cloud or a mesh, in whose frame its base is at `scene_from_base`.
    ///
    /// Several may share a robot. A scan must not hold the robot itself: see [`Robot::self_filter`]. A base that
    /// touches what it stands on, or is out of the camera's view, collides or is undecided at any positions:
    /// see [`Self::allow`].
    ///
    /// # Errors
    /// When the pose is not finite, or a link is called [`SURROUNDINGS`].
    pub fn new(
        robot: impl Into<Arc<Robot>>,
        surroundings: impl Into<Arc<Body>>,
        scene_from_base: Pose,
        touching: Touching,
    ) -> Result<Self, SceneError> {
        let robot = robot.into();
        let mut scene = Scene::default();
        scene.add(SURROUNDINGS, surroundings, Pose::identity())?;
        let carried = Carried::shapes_of(&robot);
        for part in &carried {
            scene.add(&part.name, Arc::clone(&part.body), scene_from_base)?;
        }
        let mut checker = Self { robot, scene, carried, scene_from_base, touching };
        for place in 0..checker.carried.len() {
            checker.allow_what_may_touch(place)?;
        }
        Ok(checker)
    }

    /// Allows the pairs of a part and those before it that are not asked about.
    pub(crate) fn allow_what_may_touch(&mut self, place: usize) -> Result<(), SceneError> {
        let Self { robot, scene, carried, touching, .. } = self;
        let part = &carried[place];
        for other in &carried[..place] {
            let [link, beside] = [part, other].map(|part| &robot.tree.links[part.link]);
            let are_parts_of_links = part.is_shape && other.is_shape;
            if *touching == Touching::Surroundings
                || part.link == other.link
                || are_parts_of_links && robot.is_allowed(link, beside)
            {
                scene.allow(&part.name, &other.name)?;
            }
        }
        Ok(())
    }

    /// The robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// Puts others in the place of the surroundings, such as the next scan, and returns those.
    ///
    /// # Errors
    /// Never as it stands: there always are surroundings.
    pub fn replace_surroundings(
        &mut self,
        surroundings: impl Into<Arc<Body>>,
    ) -> Result<Arc<Body>, SceneError> {
        self.scene.replace(SURROUNDINGS, surroundings)
    }

    /// All pairs that do not read as free with the joints at these positions, rad and m, the worst
    /// first, each with its report: contacts are in the frame of the surroundings. `joints` has every joint
    /// that moves and mimics no other, by its name.
    ///
    /// The two of a pair are named [`SURROUNDINGS`], by the link, with a number from 0 where it has several
    /// `<collision>` shapes (`finger/2`), and by what is held. It is [`Scene::check`], with the same bits on any
    /// number of threads.
    ///
    /// # Errors
    /// When a joint is unknown, left out, not finite or beyond its limits, or a link 1e10 m away. A pair that
    /// cannot be asked is among those returned.
    pub fn check(
        &self,
        query: &Query,
        joints: &BTreeMap<String, f64>,
    ) -> Result<Checked, JointsError> {
        Ok(self.scene_at(joints)?.check(query))
    }

    /// Whether the robot is free there: the verdict of [`Self::check`], sooner ([`Scene::is_free`]), for planners.
    ///
    /// # Errors
    /// As [`Self::check`]; a pair that cannot be asked is not free.
    pub fn is_free(
        &self,
        query: &Query,
        joints: &BTreeMap<String, f64>,
    ) -> Result<bool, JointsError> {
        Ok(self.scene_at(joints)?.is_free(query))
    }

    /// The surroundings, the links and what is held as a scene, in the frame of the surroundings and by their names as
    /// in [`Self::check`], for what else a scene can be asked or to be drawn.
    ///
    /// # Errors
    /// As [`Self::check`].
    pub fn scene_at(&self, joints: &BTreeMap<String, f64>) -> Result<Scene, JointsError> {
        Ok(self.placed(&self.robot.tree.positions(joints)?)?)
    }

    /// Lowest and highest corner of the surroundings, of each link and of what is held, along the axes of the frame
    /// of the surroundings, m, by their names as in [`Self::check`], never too small. For people to see whether the base is where they
    /// meant.
    ///
    /// # Errors
    /// As [`Self::check`].
    pub fn boxes(
        &self,
        joints: &BTreeMap<String, f64>,
    ) -> Result<BTreeMap<String, [Point3; 2]>, JointsError> {
        let scene = self.scene_at(joints)?;
        Ok(scene.boxes().into_iter().map(|(name, corners)| (name.to_owned(), corners)).collect())
    }

    /// The scene with the joints at these positions.
    pub(crate) fn placed(&self, positions: &[f64]) -> Result<Scene, SceneError> {
        let poses = self.robot.tree.poses(positions);
        let mut scene = self.scene.clone();
        for part in &self.carried {
            scene.set_pose(&part.name, self.scene_from_base.after(&part.pose(&poses)))?;
        }
        Ok(scene)
    }
}
