//! What the library says of fresh clouds: both modes, and the oracle.

use anyhow::Result;
use cloudtouch::{
    Body, Cloud, CloudSettings, Mesh, Mode, Query, QuerySettings, Recalibration, noise::SensorModel,
};
use cloudtouch_geom::{PointCloud, Pose, TriangleMesh, UnitVector3};
use cloudtouch_testkit::family::{Family, Observation};

use super::{ORACLE, OURS, plan::Methods, record::Said};
use crate::calibrate::Fitted;

/// The queries that are asked of one family.
pub(super) struct Ours {
    /// Whether the moving body is given as its exact mesh, as a user gives a gripper.
    knows_object: bool,
    calibrated: Query,
    oracle: Option<Query>,
    paper: Option<Query>,
}

impl Ours {
    /// With constants fitted on other families.
    pub(super) fn try_new(methods: Methods, family: Family, fitted: &Fitted) -> Result<Self> {
        let defaults = match methods {
            Methods::Ours | Methods::All => QuerySettings::new(Mode::Calibrated),
            Methods::Evidence => QuerySettings {
                doubt: [0.0, 1.0],
                stop_above: 1.0,
                ..QuerySettings::new(Mode::Calibrated)
            },
        };
        let calibrated = |recalibration: Recalibration| -> Result<Query> {
            Ok(Query::new(QuerySettings { recalibration, ..defaults })?)
        };
        let oracle = || calibrated(fitted.oracle_to_judge(family.name())?);
        let paper = || -> Result<Query> { Ok(Query::new(QuerySettings::new(Mode::Paper))?) };
        Ok(Self {
            knows_object: family == Family::Tabletop,
            calibrated: calibrated(fitted.to_judge(family.name())?)?,
            oracle: (methods != Methods::Ours).then(oracle).transpose()?,
            paper: (methods == Methods::All).then(paper).transpose()?,
        })
    }

    /// The answers to one pose; `object` is the surface behind the moving cloud.
    pub(super) fn answer(
        &self,
        object: &TriangleMesh,
        observed: [&Observation; 2],
        a_from_b: &Pose,
    ) -> Result<Vec<(&'static str, Said)>> {
        let ask = |query: &Query, prepare: &dyn Fn(&Observation) -> Result<Cloud>| {
            let [a, b] = observed;
            let body_b = if self.knows_object {
                Body::Mesh(Mesh::prepare(object)?)
            } else {
                Body::Cloud(prepare(b)?)
            };
            anyhow::Ok(Said::from(&query.run(&prepare(a)?, &body_b, a_from_b)?))
        };
        let mut all = vec![(OURS, ask(&self.calibrated, &|o| as_seen(o, Mode::Calibrated))?)];
        if let Some(query) = &self.oracle {
            all.push((ORACLE, ask(query, &exact)?));
        }
        if let Some(query) = &self.paper {
            all.push(("paper", ask(query, &|o| as_seen(o, Mode::Paper))?));
        }
        Ok(all)
    }
}

fn as_seen(observation: &Observation, mode: Mode) -> Result<Cloud> {
    let sensor = match &observation.cloud.covariances {
        Some(_) => SensorModel::PerPoint,
        None => SensorModel::Isotropic { std: observation.std },
    };
    Ok(Cloud::prepare(&observation.cloud, &CloudSettings::new(sensor, mode))?)
}

/// The cloud with every sampled point where it truly is and the true normal of the surface there:
/// what sampling alone leaves to be known. Points that no surface made are left out.
fn exact(observation: &Observation) -> Result<Cloud> {
    let samples = || observation.truth.iter().flatten();
    let cloud = PointCloud {
        normals: Some(samples().map(|s| UnitVector3::new_normalize(s.normal)).collect()),
        ..PointCloud::from_points(samples().map(|s| s.position).collect())
    };
    let sensor = SensorModel::Isotropic { std: 0.0 };
    Ok(Cloud::prepare(&cloud, &CloudSettings::new(sensor, Mode::Calibrated))?)
}
