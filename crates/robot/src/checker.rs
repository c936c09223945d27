//! A robot in its surroundings.

use std::collections::BTreeMap;
use std::sync::Arc;

use cloudtouch::geom::Pose;
use cloudtouch::{Body, Checked, Query, Scene, SceneError};

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
    /// For each shape its name in the scene.
    pub(crate) names: Vec<String>,
    pub(crate) scene_from_base: Pose,
}

impl RobotChecker {
    /// Puts a robot into a cloud or a mesh, in whose frame its base is at `scene_from_base`.
    ///
    /// Several may share a robot. A scan must not hold the robot itself: see [`Robot::self_filter`].
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
        let names = robot.body_names();
        for (name, shape) in names.iter().zip(&robot.shapes) {
            scene.add(name, Arc::clone(&shape.body), scene_from_base)?;
        }
        let link = |place: usize| &robot.tree.links[robot.shapes[place].link];
        for i in 0..names.len() {
            for j in 0..i {
                if touching == Touching::Surroundings
                    || link(i) == link(j)
                    || robot.may_touch(link(i), link(j))
                {
                    scene.allow(&names[i], &names[j])?;
                }
            }
        }
        Ok(Self { robot, scene, names, scene_from_base })
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
    /// first, each with its report: contacts are in the frame of the surroundings.
    ///
    /// It is [`Scene::check`], with the same bits on any number of threads.
    ///
    /// # Errors
    /// When a joint is unknown, left out, not finite or beyond its limits, or a link 1e10 m
    /// away. A pair that cannot be asked
    /// is among those returned.
    pub fn check(
        &self,
        query: &Query,
        joints: &BTreeMap<String, f64>,
    ) -> Result<Checked, JointsError> {
        Ok(self.placed(&self.robot.tree.positions(joints)?)?.check(query))
    }

    /// The scene with the joints at these positions.
    pub(crate) fn placed(&self, positions: &[f64]) -> Result<Scene, SceneError> {
        let poses = self.robot.tree.poses(positions);
        let mut scene = self.scene.clone();
        for (name, shape) in self.names.iter().zip(&self.robot.shapes) {
            scene.set_pose(name, self.scene_from_base.after(&poses[shape.link]))?;
        }
        Ok(scene)
    }
}
