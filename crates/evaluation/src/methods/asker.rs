//! Either path by name, for what is measured of both.

use anyhow::Result;
use cloudtouch::{
    Cloud, CloudSettings, Mesh, PaperCloud, PaperCloudSettings, PaperQuery, PaperSettings, Query,
    QuerySettings, Report, noise::SensorModel,
};
use cloudtouch_geom::{PointCloud, Pose};

/// Which path answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// The default, at its default settings.
    Calibrated,
    /// The paper's, as printed.
    Printed,
    /// The paper's with all our amendments.
    Amended,
}

impl Way {
    /// The settings of the paper's path.
    pub fn paper(self, sensor: SensorModel) -> (PaperSettings, PaperCloudSettings) {
        match self {
            Self::Amended => (PaperSettings::amended(), PaperCloudSettings::amended(sensor)),
            _ => (PaperSettings::default(), PaperCloudSettings::new(sensor)),
        }
    }
}

/// What says how likely a mesh collides with the cloud it was made for.
type Asker = Box<dyn Fn(&Mesh, &Pose) -> Result<Report>>;

/// Prepares a cloud with the same noise everywhere, m, to be asked about meshes.
///
/// # Errors
/// When the cloud is refused.
pub fn asker(cloud: &PointCloud, std: f64, way: Way) -> Result<Asker> {
    let sensor = SensorModel::Isotropic { std };
    Ok(match way {
        Way::Calibrated => {
            let query = Query::new(QuerySettings::default())?;
            let cloud = Cloud::prepare(cloud, &CloudSettings::new(sensor))?;
            Box::new(move |mesh, pose| Ok(query.run(&cloud, mesh, pose)?))
        }
        Way::Printed | Way::Amended => {
            let (query, cloud_by) = way.paper(sensor);
            let query = PaperQuery::new(query)?;
            let cloud = PaperCloud::prepare(cloud, &cloud_by)?;
            Box::new(move |mesh, pose| Ok(query.run(&cloud, mesh, pose)?))
        }
    })
}
