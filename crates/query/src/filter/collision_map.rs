//! The collision map of a planner: one point per occupied cell.

use cloudtouch_geom::PointCloud;
use cloudtouch_noise::{NoiseError, quantize_to_grid};

pub(super) fn cell_centers(cloud: &PointCloud, resolution: f64) -> Result<PointCloud, NoiseError> {
    let points = quantize_to_grid(&cloud.points, resolution)?;
    Ok(PointCloud { sensor_pose: cloud.sensor_pose, ..PointCloud::from_points(points) })
}
