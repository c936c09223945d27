//! The collision map of a planner: one point per occupied cell.

use cloudtouch_geom::PointCloud;
use cloudtouch_noise::{NoiseError, quantize_to_grid};

pub(super) fn cell_centers(cloud: &PointCloud, resolution: f64) -> Result<PointCloud, NoiseError> {
    Ok(PointCloud {
        points: quantize_to_grid(&cloud.points, resolution)?,
        covariances: None,
        sensor_origin: cloud.sensor_origin,
        image_size: None,
    })
}
