//! A collision map as motion planners keep it: every measured point fills a box of a grid, and
//! boxes either touch the other body or do not.

use std::time::Instant;

use anyhow::{Result, anyhow};
use cloudtouch_geom::{Point3, Pose, TriangleMesh};
use glamx::DPose3;
use parry3d_f64::{
    math::Vector,
    query::intersection_test,
    shape::{Shape, TriMesh, Voxels},
};

use super::{Draw, Method, Prepared, cleaned};
use crate::answers::{Pair, Said};

/// Boxes of this side around the points, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Boxes {
    /// Side of a box, m.
    pub side: f64,
}

struct Shapes {
    a: Voxels,
    b: Voxels,
    mesh: TriMesh,
}

impl Boxes {
    fn around(self, points: &[Point3]) -> Voxels {
        let points: Vec<Vector> = points.iter().map(vector).collect();
        Voxels::from_points(Vector::splat(self.side), &points)
    }
}

impl Method for Boxes {
    fn name(&self) -> String {
        format!("{:.0} cm boxes", 100.0 * self.side)
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Box<dyn Prepared>> {
        Ok(Box::new(Shapes {
            a: self.around(&cleaned(draw.a)?.points),
            b: self.around(&cleaned(draw.b)?.points),
            mesh: parry_mesh(draw.mesh)?,
        }))
    }
}

impl Prepared for Shapes {
    fn ask(&self, pair: Pair, a_from_b: &Pose) -> Result<Option<Said>> {
        let start = Instant::now();
        let other: &dyn Shape = match pair {
            Pair::CloudCloud => &self.b,
            Pair::CloudMesh => &self.mesh,
        };
        let pose = DPose3::from(*a_from_b.isometry());
        let touch = intersection_test(&DPose3::IDENTITY, &self.a, &pose, other)?.intersecting;
        Ok(Some(Said::yes_or_no(touch, start)))
    }
}

/// A mesh as parry keeps it.
pub(crate) fn parry_mesh(mesh: &TriangleMesh) -> Result<TriMesh> {
    let vertices = mesh.vertices().iter().map(vector).collect();
    TriMesh::new(vertices, mesh.triangles().to_vec()).map_err(|error| anyhow!("{error}"))
}

fn vector(point: &Point3) -> Vector {
    Vector::new(point.x, point.y, point.z)
}
