//! Peers that only the report on speed asks.

use std::time::Instant;

use anyhow::{Result, anyhow};
use capt::Capt;
use cloudtouch_geom::{Point3, Pose, TriangleMesh};
use glamx::DPose3;
use parry3d_f64::{query::intersection_test, shape::TriMesh};

use crate::{
    answers::{Pair, Said},
    methods::{Draw, Method, Prepared, parry_mesh, spread},
};

/// Radius of a sphere about a point, m.
const RADIUS: f32 = 0.01;

/// The surfaces that the clouds were drawn from, which no sensor knows.
pub(super) struct ExactMeshes(pub(super) [TriangleMesh; 2]);

/// Balls of 1 cm about the points of the moving body against the points of the other, up to the
/// first hit, in single precision.
pub(super) struct Spheres;

struct Meshes([TriMesh; 2]);

struct Tree {
    tree: Capt<3>,
    points: Vec<Point3>,
}

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

impl Method for Spheres {
    fn name(&self) -> String {
        "capt, spheres".into()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Box<dyn Prepared>> {
        let entries: Vec<[f32; 3]> = draw.a.cloud.points.iter().map(single).collect();
        // One lane: more take a nightly compiler.
        let tree = Capt::<3>::try_new(&entries, (RADIUS, RADIUS), 1)
            .map_err(|error| anyhow!("capt: {error:?}"))?;
        Ok(Box::new(Tree { tree, points: draw.b.cloud.points.clone() }))
    }
}

impl Prepared for Tree {
    fn ask(&self, _: Pair, a_from_b: &Pose) -> Result<Option<Said>> {
        let start = Instant::now();
        let hit = |p: &Point3| self.tree.collides(&single(&a_from_b.transform_point(p)), RADIUS);
        Ok(Some(Said::yes_or_no(spread(&self.points).any(hit), start)))
    }
}

fn single(point: &Point3) -> [f32; 3] {
    [point.x, point.y, point.z].map(|v| v as f32)
}
