//! The cloud of the default path: every point stands for the piece of surface about it.

use cloudtouch_bvh::{NodeId, Tree};
use cloudtouch_geom::{Point3, PointCloud};
use cloudtouch_noise::Scratch;

use crate::error::PrepareError;

use super::accessors::cloud_accessors;
use super::prepared::Prepared;
use super::settings::CloudSettings;
use super::surface::edge::Edge;
use super::surface::onward::Onward;
use super::surface::surfel::Surfel;

/// A noisy cloud, ready to be queried in any pose, from many threads at once.
#[derive(Debug)]
pub struct Cloud {
    pub(super) prepared: Prepared,
}

cloud_accessors!(Cloud);

impl Cloud {
    /// Filters a cloud, models its sensor, and builds its index and tree, on all threads of the pool, with the
    /// same result on one: so not within something that others of them wait for, such as a `OnceLock`.
    ///
    /// # Errors
    /// When nothing is left after filtering, a coordinate is beyond 1e10 m, a covariance is not one,
    /// or a setting is out of range.
    pub fn prepare(cloud: &PointCloud, settings: &CloudSettings) -> Result<Self, PrepareError> {
        Self::merge(&[(cloud, settings)])
    }

    /// The same of several scans of one frame, such as those of several sensors: each is filtered,
    /// and has its noise, by its own settings and the pose of its own sensor. The posterior and the
    /// tree are those of the first.
    ///
    /// Rows and filter stages are counted on from scan to scan. Space is taken for hidden where one
    /// depth image has a surface before it and no other looked into it.
    ///
    /// # Errors
    /// When there is no scan, or as [`Self::prepare`] for one of them.
    pub fn merge(scans: &[(&PointCloud, &CloudSettings)]) -> Result<Self, PrepareError> {
        let scans: Vec<_> = scans.iter().map(|&(scan, by)| (scan, by.preparation())).collect();
        // The certified traversal goes by bounds, not by coverage: any weight would do.
        Ok(Self { prepared: Prepared::new(&scans, None)? })
    }

    /// Computes the surface at every point, on all threads of the pool, and fits the tree to it.
    ///
    /// A cloud as prepared computes its surface where queries come near it, and until then has to
    /// allow for what it might be; one that is refined is searched one and a half to four times as fast, from the
    /// first query on. It takes as long as dozens of first queries, and pays for a scene that thousands of
    /// poses are tested in, not for a frame that is looked at some hundred times. Probabilities stay what
    /// they are, only what is left out of the search and the bounds on it may differ.
    ///
    /// # Errors
    /// When the surface of a point is beyond what a tree holds, as at a noise of 1e50 m.
    pub fn refined(mut self) -> Result<Self, PrepareError> {
        self.prepared.refine()?;
        Ok(self)
    }

    pub(crate) fn tree(&self) -> &Tree {
        self.prepared.tree()
    }

    pub(crate) fn leaf(&self, id: NodeId) -> (&[Surfel], bool) {
        self.prepared.leaf(id)
    }

    pub(crate) fn visit_some_of_leaf(
        &self,
        id: NodeId,
        is_wanted: impl FnMut(&Point3) -> bool,
        scratch: &mut Scratch,
        visit: impl FnMut(u32, &Surfel),
    ) -> bool {
        self.prepared.visit_some_of_leaf(id, is_wanted, scratch, visit)
    }

    pub(crate) fn onward(&self, edge: &Edge, end: usize) -> Onward {
        self.prepared.onward(edge, end)
    }

    pub(crate) fn sensor_std(&self, index: u32) -> f64 {
        self.prepared.sensor_std(index)
    }
}
