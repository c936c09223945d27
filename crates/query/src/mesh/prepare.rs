//! Triangle meshes prepared for queries: exact surfaces, with an inside where they are watertight.

mod subdivide;

use std::time::{Duration, Instant};

use cloudtouch_bvh::{Primitive, Tree, TreeSettings};
use cloudtouch_geom::{MeshError, Point3, TriangleMesh, Vector3};
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::{TriMesh, TriMeshFlags};

use crate::error::{PrepareError, SubdivisionError};
use crate::range::check_points;

pub(crate) use subdivide::{SampleRegion, sample_region};

/// Triangles in a leaf of a mesh's tree: few, since each may be subdivided many times.
const MAX_LEAF_TRIANGLES: usize = 8;

/// A triangle mesh, ready to be queried in any pose.
///
/// Its surface is exact: its points have no covariance and count as on the wrong side with
/// probability 0, ½ or 1. Where the mesh is watertight, points deep inside are found too; an open
/// mesh is a surface without an inside.
#[derive(Debug)]
pub struct Mesh {
    /// What was subtracted from file coordinates, m: far offsets keep their millimetres.
    origin: Vector3,
    surface: TriMesh,
    tree: Tree,
    watertight: bool,
    prepare_time: Duration,
}

impl Mesh {
    /// Merges vertices, looks whether the mesh is watertight, and builds its tree.
    ///
    /// # Errors
    /// When every triangle is degenerate, a coordinate is beyond 1e50 m, or the tree cannot be built.
    pub fn prepare(mesh: &TriangleMesh) -> Result<Self, PrepareError> {
        let start = Instant::now();
        let mut merged = mesh.merged();
        let Some((low, high)) = merged.bounding_box() else {
            return Err(PrepareError::Mesh(MeshError::Empty));
        };
        if merged.triangles().is_empty() {
            return Err(PrepareError::Mesh(MeshError::Empty));
        }
        check_points(merged.vertices())?;
        let origin = nalgebra::center(&low, &high).coords;
        let watertight = merged.open_edges() == 0;
        let vertices: Vec<Point3> = merged.vertices().iter().map(|p| p - origin).collect();
        let mut triangles = merged.triangles().to_vec();
        if watertight && signed_volume(&vertices, &triangles) < 0.0 {
            // Turned inside out as a whole: a common export slip that leaves no doubt.
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        merged = TriangleMesh::try_new(vertices, triangles)?;
        let flags = if watertight { TriMeshFlags::ORIENTED } else { TriMeshFlags::empty() };
        let surface = TriMesh::with_flags(
            merged.vertices().iter().map(vector).collect(),
            merged.triangles().to_vec(),
            flags,
        )
        .map_err(|error| PrepareError::Surface { reason: error.to_string() })?;
        let primitives =
            (0..merged.triangles().len()).map(|t| Primitive::Triangle(merged.corners(t))).collect();
        let settings = TreeSettings {
            max_leaf_points: MAX_LEAF_TRIANGLES,
            min_leaf_points: 1,
            ..TreeSettings::default()
        };
        let tree = Tree::build(primitives, &settings)?;
        Ok(Self { origin, surface, tree, watertight, prepare_time: start.elapsed() })
    }

    /// Whether the mesh encloses a volume: every edge joins two triangles, consistently turned.
    pub fn is_watertight(&self) -> bool {
        self.watertight
    }

    /// How many triangles there are after merging.
    pub fn triangle_count(&self) -> usize {
        self.surface.indices().len()
    }

    /// How long preparation took.
    pub fn prepare_time(&self) -> Duration {
        self.prepare_time
    }

    /// Diagonal of the bounding box, m.
    pub fn size(&self) -> f64 {
        self.surface.local_aabb().extents().length()
    }

    /// Points on the surface in the file frame, no farther apart than `spacing` metres along any
    /// triangle: for pictures. A triangle is split into no more than 4¹⁰ parts, however large.
    ///
    /// # Errors
    /// When that takes more than `max_parts` triangles before and after splitting, each of up to
    /// four points; [`MAX_MESH_PARTS`](crate::MAX_MESH_PARTS) suits most.
    pub fn surface_points(
        &self,
        spacing: f64,
        max_parts: usize,
    ) -> Result<Vec<Point3>, SubdivisionError> {
        let everywhere = SampleRegion {
            center: Point3::origin(),
            core: f64::INFINITY,
            radius: f64::INFINITY,
            spacing,
        };
        let triangles = (0..self.triangle_count()).map(|t| self.corners(t));
        let mut points = sample_region(triangles, &everywhere, max_parts)?;
        points.iter_mut().for_each(|p| *p += self.origin);
        Ok(points)
    }

    /// Distance from a point in the mesh's file frame to the surface, m; negative inside a
    /// watertight mesh, never negative for an open one. NaN for a point that is not finite.
    pub fn signed_distance(&self, point: &Point3) -> f64 {
        self.project(&(point - self.origin)).signed_distance
    }

    /// Whether a point (file frame) is inside or within `padding` metres of the surface.
    pub(crate) fn is_within(&self, point: &Point3, padding: f64) -> bool {
        self.signed_distance(point) <= padding
    }

    /// The nearest surface point to a point in the local frame.
    pub(crate) fn project(&self, point: &Point3) -> Projection {
        if !point.iter().all(|v| v.is_finite()) {
            return Projection { point: *point, triangle: None, signed_distance: f64::NAN };
        }
        let (projection, (triangle, _)) =
            self.surface.project_local_point_and_get_location(vector(point), false);
        let nearest = Point3::new(projection.point.x, projection.point.y, projection.point.z);
        let distance = (point - nearest).norm();
        let inside = self.watertight && projection.is_inside;
        let signed_distance = if inside { -distance } else { distance };
        Projection { point: nearest, triangle: Some(triangle as usize), signed_distance }
    }

    /// Unit normal of a triangle, outward for a watertight mesh; `None` for a degenerate one.
    pub(crate) fn normal(&self, triangle: usize) -> Option<Vector3> {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(&(c - a)).try_normalize(0.0)
    }

    pub(crate) fn origin(&self) -> Vector3 {
        self.origin
    }

    pub(crate) fn tree(&self) -> &Tree {
        &self.tree
    }

    pub(crate) fn surface(&self) -> &TriMesh {
        &self.surface
    }

    /// Corners of a triangle in the local frame.
    pub(crate) fn corners(&self, triangle: usize) -> [Point3; 3] {
        let vertices = self.surface.vertices();
        self.surface.indices()[triangle].map(|i| {
            let v = vertices[i as usize];
            Point3::new(v.x, v.y, v.z)
        })
    }
}

/// Where a point projects to on the surface of a mesh, in the mesh's local frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Projection {
    /// The nearest point of the surface.
    pub point: Point3,
    /// The triangle it lies on; `None` for a point that is not finite.
    pub triangle: Option<usize>,
    /// Distance to it, m; negative inside.
    pub signed_distance: f64,
}

fn vector(point: &Point3) -> Vector {
    Vector::new(point.x, point.y, point.z)
}

fn signed_volume(vertices: &[Point3], triangles: &[[u32; 3]]) -> f64 {
    let volume_of = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| vertices[i as usize].coords);
        a.dot(&b.cross(&c)) / 6.0
    };
    triangles.iter().map(volume_of).sum()
}
