//! The cloud of the paper's path.

use cloudtouch_geom::PointCloud;

use crate::cloud::{Prepared, cloud_accessors};
use crate::error::PrepareError;

use super::cloud_settings::PaperCloudSettings;
use super::weights::sphere_area;

/// A noisy cloud, ready to be queried by the paper in any pose, from many threads at once.
#[derive(Debug)]
pub struct PaperCloud {
    prepared: Prepared,
}

cloud_accessors!(PaperCloud);

impl PaperCloud {
    /// Filters a cloud, models its sensor, and builds its index and tree.
    ///
    /// # Errors
    /// When nothing is left after filtering, a coordinate is beyond 1e50 m, a covariance is not one,
    /// or a setting is out of range.
    pub fn prepare(
        cloud: &PointCloud,
        settings: &PaperCloudSettings,
    ) -> Result<Self, PrepareError> {
        let neighbors = settings.discretization.neighbors;
        let area = |near: &_, index| sphere_area(near, index, neighbors);
        Ok(Self { prepared: Prepared::new(cloud, &settings.preparation(), area)? })
    }
}
