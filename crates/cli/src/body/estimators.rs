//! How the default path answers, and the paper's.

use cloudtouch::geom::Pose;
use cloudtouch::paper::LeafClassifier;
use cloudtouch::{
    BodyRef, Cloud, PaperBodyRef, PaperCloud, PaperQuery, Penetration, Placement, PoseDistribution,
    PoseGradient, Query, QueryError, Report, UnderPoses,
};

use super::{Body, Estimator};
use crate::margin::{Nearness, SHARE};

impl Estimator for Query {
    type Cloud = Cloud;

    fn ask(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &Pose,
    ) -> Result<Report, QueryError> {
        self.run(scene, object, scene_from_object)
    }

    fn ask_within(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &Pose,
        margin: Option<f64>,
    ) -> Result<(Report, Option<Nearness>), QueryError> {
        let Some(margin) = margin else {
            return Ok((self.ask(scene, object, scene_from_object)?, None));
        };
        let (report, within, interval) =
            self.nearness(scene, object, scene_from_object, margin, SHARE)?;
        Ok((report, Some(Nearness { within, interval })))
    }

    fn uncertain(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &PoseDistribution,
    ) -> Result<Option<UnderPoses>, QueryError> {
        Ok(Some(self.run_uncertain(scene, object, scene_from_object)?.1))
    }

    fn slopes(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &Pose,
    ) -> Result<Option<PoseGradient>, QueryError> {
        Ok(Some(self.gradient(scene, object, scene_from_object)?.1))
    }

    fn way_out(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &Pose,
        probability: f64,
    ) -> Result<Option<Penetration>, QueryError> {
        Ok(self.penetration(scene, object, scene_from_object, probability)?.1)
    }

    fn place(
        &self,
        scene: &Body<Cloud>,
        object: &Body<Cloud>,
        scene_from_object: &Pose,
    ) -> Placement {
        BodyRef::from(scene).placement(object.into(), scene_from_object)
    }
}

impl Estimator for PaperQuery {
    type Cloud = PaperCloud;

    fn ask(
        &self,
        scene: &Body<PaperCloud>,
        object: &Body<PaperCloud>,
        scene_from_object: &Pose,
    ) -> Result<Report, QueryError> {
        self.run(scene, object, scene_from_object)
    }

    fn explain(
        &self,
        scene: &Body<PaperCloud>,
        object: &Body<PaperCloud>,
        scene_from_object: &Pose,
    ) -> Result<(Report, Vec<LeafClassifier>), QueryError> {
        Self::explain(self, scene, object, scene_from_object)
    }

    fn place(
        &self,
        scene: &Body<PaperCloud>,
        object: &Body<PaperCloud>,
        scene_from_object: &Pose,
    ) -> Placement {
        PaperBodyRef::from(scene).placement(object.into(), scene_from_object)
    }
}
