//! The peer that only the report on speed asks.

use std::time::Instant;

use anyhow::Result;
use cloudtouch_geom::{Pose, TriangleMesh};
use glamx::DPose3;
use parry3d_f64::{query::intersection_test, shape::TriMesh};

use crate::{
    answers::{Pair, Said},
    methods::{Draw, Method, Prepared, parry_mesh},
};

/// The surfaces that the clouds were drawn from, which no sensor knows.
pub(super) struct ExactMeshes(pub(super) [TriangleMesh; 2]);

struct Meshes([TriMesh; 2]);

impl Method for ExactMeshes {
    fn name(&self) -> String {
        "parry3d, exact meshes".into()
    }

    fn prepare(&self, _: &Draw<'_>) -> Result<Box<dyn Prepared>> {
        Ok(Box::new(Meshes([parry_mesh(&self.0[0])?, parry_mesh(&self.0[1])?])))
    }
}

impl Prepared for Meshes {
    fn ask(&self, _: Pair, a_from_b: &Pose) -> Result<Option<Said>> {
        let start = Instant::now();
        let placed = DPose3::from(*a_from_b.isometry());
        let touch = intersection_test(&DPose3::IDENTITY, &self.0[0], &placed, &self.0[1])?;
        Ok(Some(Said::yes_or_no(touch.intersecting, start)))
    }
}
