//! What is asked of either path.

use cloudtouch::geom::Pose;
use cloudtouch::paper::LeafClassifier;
use cloudtouch::{
    Penetration, Placement, PoseDistribution, PoseGradient, QueryError, Report, UnderPoses,
};

use super::{Body, PreparedCloud};
use crate::margin::Nearness;

/// The default path or the paper's: it asks only about bodies that were prepared for it.
pub(crate) trait Estimator: Sync {
    type Cloud: PreparedCloud;

    /// How likely it is that two bodies collide.
    fn ask(
        &self,
        scene: &Body<Self::Cloud>,
        object: &Body<Self::Cloud>,
        scene_from_object: &Pose,
    ) -> Result<Report, QueryError>;

    /// The same with the classifiers trained, of which the default path tells none.
    fn explain(
        &self,
        scene: &Body<Self::Cloud>,
        object: &Body<Self::Cloud>,
        scene_from_object: &Pose,
    ) -> Result<(Report, Vec<LeafClassifier>), QueryError> {
        Ok((self.ask(scene, object, scene_from_object)?, Vec::new()))
    }

    /// The same with how likely they are within a margin (m) of each other, where one is asked about; the
    /// paper's path knows no distances.
    fn ask_within(
        &self,
        scene: &Body<Self::Cloud>,
        object: &Body<Self::Cloud>,
        scene_from_object: &Pose,
        _margin: Option<f64>,
    ) -> Result<(Report, Option<Nearness>), QueryError> {
        Ok((self.ask(scene, object, scene_from_object)?, None))
    }

    /// How likely a collision is over all poses that may be; `None` on the paper's path.
    fn uncertain(
        &self,
        _scene: &Body<Self::Cloud>,
        _object: &Body<Self::Cloud>,
        _scene_from_object: &PoseDistribution,
    ) -> Result<Option<UnderPoses>, QueryError> {
        Ok(None)
    }

    /// What a small motion of the object changes; `None` on the paper's path.
    fn slopes(
        &self,
        _scene: &Body<Self::Cloud>,
        _object: &Body<Self::Cloud>,
        _scene_from_object: &Pose,
    ) -> Result<Option<PoseGradient>, QueryError> {
        Ok(None)
    }

    /// The least translation found that ends a collision; `None` where none does, and on the paper's path.
    fn way_out(
        &self,
        _scene: &Body<Self::Cloud>,
        _object: &Body<Self::Cloud>,
        _scene_from_object: &Pose,
        _probability: f64,
    ) -> Result<Option<Penetration>, QueryError> {
        Ok(None)
    }

    /// Where the object lies in the scene.
    fn place(
        &self,
        scene: &Body<Self::Cloud>,
        object: &Body<Self::Cloud>,
        scene_from_object: &Pose,
    ) -> Placement;
}
