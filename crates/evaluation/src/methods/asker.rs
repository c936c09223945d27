//! Either path by name, at its default settings, for what is measured of both.

use anyhow::Result;
use cloudtouch::{
    Cloud, CloudSettings, Mesh, Mode, PaperCloud, PaperCloudSettings, PaperQuery, PaperSettings,
    Query, QuerySettings, Report, noise::SensorModel,
};
use cloudtouch_geom::{PointCloud, Pose};

/// What says how likely a mesh collides with the cloud it was made for.
type Asker = Box<dyn Fn(&Mesh, &Pose) -> Result<Report>>;

/// Prepares a cloud with the same noise everywhere, m, to be asked about meshes.
///
/// # Errors
/// When the cloud is refused.
pub fn asker(cloud: &PointCloud, std: f64, mode: Mode) -> Result<Asker> {
    let sensor = SensorModel::Isotropic { std };
    Ok(match mode {
        Mode::Calibrated => {
            let query = Query::new(QuerySettings::default())?;
            let cloud = Cloud::prepare(cloud, &CloudSettings::new(sensor))?;
            Box::new(move |mesh, pose| Ok(query.run(&cloud, mesh, pose)?))
        }
        Mode::Paper => {
            let query = PaperQuery::new(PaperSettings::default())?;
            let cloud = PaperCloud::prepare(cloud, &PaperCloudSettings::new(sensor))?;
            Box::new(move |mesh, pose| Ok(query.run(&cloud, mesh, pose)?))
        }
    })
}
