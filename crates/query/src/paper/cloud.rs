//! The cloud of the paper's path.

use cloudtouch_geom::PointCloud;
use cloudtouch_noise::{Neighborhoods, NoiseError, RadiusRule};

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
    /// When nothing is left after filtering, a coordinate is beyond 1e10 m, a covariance is not one,
    /// or a setting is out of range.
    pub fn prepare(
        cloud: &PointCloud,
        settings: &PaperCloudSettings,
    ) -> Result<Self, PrepareError> {
        Self::merge(&[(cloud, settings)])
    }

    /// The same of several scans of one frame, such as those of several sensors: each is filtered,
    /// and has its noise, by its own settings and the pose of its own sensor. The model is that of
    /// the first, but for the motion.
    ///
    /// Rows and filter stages are counted on from scan to scan. Space is taken for hidden where one
    /// depth image has a surface before it and no other looked into it.
    ///
    /// # Errors
    /// When there is no scan, or as [`Self::prepare`] for one of them.
    pub fn merge(scans: &[(&PointCloud, &PaperCloudSettings)]) -> Result<Self, PrepareError> {
        let neighbors = scans.first().map_or(0, |(_, by)| by.model.discretization.neighbors);
        let area = |near: &Neighborhoods, index| sphere_area(near, index, neighbors);
        let scans: Vec<_> = scans.iter().map(|&(scan, by)| (scan, by.preparation())).collect();
        Ok(Self { prepared: Prepared::new(&scans, Some(&area))? })
    }

    /// How many points the leaves of the tree hold, one that lies where siblings overlap counted in each
    /// (section 5): what storage takes.
    pub fn stored_points(&self) -> usize {
        self.prepared.stored_points()
    }

    /// Gives each point a κ of its own, in place of that of the query (eq. 11, 12): the probability
    /// with which it is to lie on its side, one for each point kept, in their order.
    ///
    /// # Errors
    /// When there are not as many as points, or one is outside the range of the rule.
    pub fn with_kappas(mut self, kappas: &[f64], rule: RadiusRule) -> Result<Self, PrepareError> {
        if kappas.len() != self.len() {
            return Err(PrepareError::KappaCount { points: self.len(), kappas: kappas.len() });
        }
        let radii: Result<Vec<f64>, NoiseError> =
            kappas.iter().map(|&kappa| rule.radius(kappa)).collect();
        self.prepared.set_radii(radii?);
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Point3;
    use cloudtouch_noise::SensorModel;

    use super::*;

    /// A grid of `side`³ points about the origin.
    fn grid(side: i32, spacing: f64) -> impl Iterator<Item = Point3> {
        let at = move |i: i32| spacing * (f64::from(i) - 0.5 * f64::from(side - 1));
        (0..side.pow(3))
            .map(move |i| Point3::new(at(i % side), at(i / side % side), at(i / side.pow(2))))
    }

    /// A dense cluster amid few points, most of which lie on the faces of the box: by number most of
    /// the surface was covered, by area little of it is.
    #[test]
    fn many_points_of_a_small_surface_hid_what_leaks_elsewhere() {
        let points = grid(5, 0.1).chain(grid(8, 0.01)).collect();
        let cloud = PointCloud::from_points(points);
        let settings = PaperCloudSettings::new(SensorModel::Isotropic { std: 0.01 });
        let by_area = PaperCloud::prepare(&cloud, &settings).unwrap();
        let by_number = Prepared::new(&[(&cloud, settings.preparation())], None).unwrap();
        let leakage = |cloud: &Prepared| 1.0 - cloud.tree().root().unwrap().coverage();
        let (by_area, by_number) = (leakage(by_area.prepared()), leakage(&by_number));
        // Of 125 points 98 lie on faces, each with at least half a chance of being outside.
        assert!(by_number < 0.2, "{by_number}");
        assert!(by_area > 0.35, "{by_area}");
    }
}
