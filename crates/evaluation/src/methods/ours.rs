//! Ours: the default, the paper's mode, either with any setting changed, and the oracle.

use anyhow::Result;
use cloudtouch::{
    Cloud, CloudSettings, Mesh, Mode, Query, QuerySettings, bvh::TreeSettings, noise::SensorModel,
};
use cloudtouch_geom::{PointCloud, Pose, UnitVector3};
use cloudtouch_testkit::family::Observation;

use super::{Draw, Fitted, Method, Prepared, sensor_of};
use crate::answers::{Pair, Said};

/// The query with some settings.
pub struct Ours {
    name: String,
    /// Settings of the query; the recalibration is that fitted without the family asked about.
    pub query: QuerySettings,
    /// Settings of the trees of clouds.
    pub tree: TreeSettings,
    /// Whether the surface is computed everywhere beforehand.
    is_refined: bool,
    /// Whether it is given the points without noise and the true normals.
    sees_truth: bool,
    fitted: Fitted,
}

impl Ours {
    /// The defaults of a mode.
    ///
    /// # Errors
    /// When the stored fit cannot be read.
    pub fn new(name: &str, mode: Mode) -> Result<Self> {
        Ok(Self {
            name: name.to_owned(),
            query: QuerySettings::new(mode),
            tree: CloudSettings::new(SensorModel::Exact, mode).tree,
            is_refined: false,
            sees_truth: false,
            fitted: Fitted::stored()?,
        })
    }

    /// The default, given every sampled point as it truly is: what sampling alone leaves to be known.
    ///
    /// # Errors
    /// When the stored fit cannot be read.
    pub fn oracle(name: &str) -> Result<Self> {
        Ok(Self { sees_truth: true, ..Self::new(name, Mode::Calibrated)? })
    }

    /// The same, gathering all evidence however clear the first of it is.
    pub fn gathering_everything(mut self) -> Self {
        self.query.doubt = [0.0, 1.0];
        self.query.stop_above = 1.0;
        self
    }

    /// The same, computing the surface of both clouds beforehand.
    pub fn refined(self) -> Self {
        Self { is_refined: true, ..self }
    }

    fn cloud(&self, observation: &Observation) -> Result<Cloud> {
        let exact;
        let (cloud, sensor) = if self.sees_truth {
            exact = true_points(observation);
            (&exact, SensorModel::Isotropic { std: 0.0 })
        } else {
            (&observation.cloud, sensor_of(observation))
        };
        let settings =
            CloudSettings { tree: self.tree, ..CloudSettings::new(sensor, self.query.mode) };
        let cloud = Cloud::prepare(cloud, &settings)?;
        if self.is_refined { Ok(cloud.refined()?) } else { Ok(cloud) }
    }
}

/// The sampled points where they truly are, with the normals of the surface there; points that no
/// surface made are left out.
fn true_points(observation: &Observation) -> PointCloud {
    let samples = || observation.truth.iter().flatten();
    PointCloud {
        normals: Some(samples().map(|s| UnitVector3::new_normalize(s.normal)).collect()),
        ..PointCloud::from_points(samples().map(|s| s.position).collect())
    }
}

struct Bodies {
    query: Query,
    a: Cloud,
    b: Cloud,
    mesh: Mesh,
}

impl Method for Ours {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Box<dyn Prepared>> {
        let recalibration = self.fitted.to_judge(draw.family, self.sees_truth)?;
        Ok(Box::new(Bodies {
            query: Query::new(QuerySettings { recalibration, ..self.query })?,
            a: self.cloud(draw.a)?,
            b: self.cloud(draw.b)?,
            mesh: Mesh::prepare(draw.mesh)?,
        }))
    }
}

impl Prepared for Bodies {
    fn ask(&self, pair: Pair, a_from_b: &Pose) -> Result<Option<Said>> {
        let report = match pair {
            Pair::CloudCloud => self.query.run(&self.a, &self.b, a_from_b)?,
            Pair::CloudMesh => self.query.run(&self.a, &self.mesh, a_from_b)?,
        };
        Ok(Some(Said::from(&report)))
    }
}
