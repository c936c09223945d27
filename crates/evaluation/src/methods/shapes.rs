//! Yes or no by parry3d: a collision map as motion planners keep it, where every measured point
//! fills a box of a grid, and the exact surfaces, which no sensor knows.

use std::time::Instant;

use anyhow::Result;
use cloudtouch_geom::{Point3, TriangleMesh};
use cloudtouch_testkit::exact::{parry_pose, parry_vector, trimesh};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::intersection_test;
use parry3d_f64::shape::{Shape, Voxels};

use super::{Draw, Method, Prepared, cleaned};
use crate::answers::Said;

/// Boxes of 1 cm around the points.
pub struct Boxes;

/// Side of a box, m.
const SIDE: f64 = 0.01;

/// The surfaces that the clouds were drawn from.
pub struct ExactMeshes(pub [TriangleMesh; 2]);

impl Method for Boxes {
    fn name(&self) -> String {
        "1 cm boxes".into()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared> {
        let around = |points: &[Point3]| -> Box<dyn Shape> {
            let points: Vec<Vector> = points.iter().map(|p| parry_vector(&p.coords)).collect();
            Box::new(Voxels::from_points(Vector::splat(SIDE), &points))
        };
        let [a, b] = [draw.a, draw.b].map(cleaned);
        shapes(around(&a?.points), around(&b?.points), draw.mesh)
    }
}

impl Method for ExactMeshes {
    fn name(&self) -> String {
        "parry3d, exact meshes".into()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared> {
        let [a, b] = self.0.each_ref().map(|mesh| -> Box<dyn Shape> { Box::new(trimesh(mesh)) });
        shapes(a, b, draw.mesh)
    }
}

/// Whether they intersect, with the second or with the mesh.
fn shapes(a: Box<dyn Shape>, b: Box<dyn Shape>, mesh: &TriangleMesh) -> Result<Prepared> {
    let mesh = trimesh(mesh);
    Ok(Box::new(move |pair, a_from_b| {
        let start = Instant::now();
        let moving: &dyn Shape = pair.pick(&*b, &mesh);
        let pose = parry_pose(a_from_b);
        let touch = intersection_test(&Pose::IDENTITY, &*a, &pose, moving)?.intersecting;
        Ok(Some(Said::score(f64::from(u8::from(touch)), start)))
    }))
}
