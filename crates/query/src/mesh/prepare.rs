//! From the triangles of a file to a mesh that can be asked.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

use cloudtouch_bvh::{Primitive, Split, Tree, TreeError, TreeSettings};
use cloudtouch_geom::{MeshError, Point3, TriangleMesh, Vector3};
use parry3d_f64::math::Vector;
use parry3d_f64::shape::TriMesh;

use crate::check::coordinates::check_points;
use crate::check::rounded::single_step;
use crate::error::PrepareError;

use super::cells::Cells;
use super::parts::{Part, parts};
use super::solids::Solids;
use super::winding::Winding;

/// Triangles in a leaf of the tree that is searched.
const LEAF_TRIANGLES: usize = 16;
/// The same for the paper's path: fewer, since each is subdivided many times.
const PAPER_LEAF_TRIANGLES: usize = 8;

/// Places that stand for the surface where only its whole extent matters.
const SAMPLES: usize = 2000;

/// A triangle mesh, ready to be queried in any pose.
///
/// Its surface is exact: its points have no covariance and count as on the wrong side with
/// probability 0, ½ or 1. Points deep inside a closed part of it are found too; an open part is a
/// surface without an inside, and takes nothing from that of others. Vertices that no triangle uses
/// count for nothing.
#[derive(Debug)]
pub struct Mesh {
    /// What was subtracted from file coordinates, m: far offsets keep their millimetres.
    origin: Vector3,
    surface: TriMesh,
    tree: Tree,
    /// The tree of the paper's path, once that is needed.
    paper_tree: OnceLock<Tree>,
    /// Of what has an inside, or of all where nothing has.
    pub(super) winding: Winding,
    /// Of the rest.
    pub(super) sheets: Option<Winding>,
    /// Corners of the triangles that an open mesh lacks.
    pub(super) missing: Vec<[Point3; 3]>,
    /// One of each connected part.
    vertices_of_parts: Vec<Point3>,
    watertight: bool,
    closed: bool,
    /// Whether some part of it is closed.
    has_solids: bool,
    /// Of each triangle whether its normal leads out of a closed part with an inside.
    leads_out: Vec<bool>,
    /// How far apart coordinates of the file are, m, where that may matter.
    pub(super) step: Option<f64>,
    /// On which side places are, once that is needed.
    pub(super) cells: OnceLock<Cells>,
    /// Places that stand for the surface, once they are needed.
    samples: OnceLock<Vec<Point3>>,
    prepare_time: Duration,
}

impl Mesh {
    /// Merges vertices, drops triangles that repeat others ([`TriangleMesh::without_repeats`]), turns them
    /// alike ([`TriangleMesh::turned_alike`]), looks whether the mesh is watertight, and builds its tree.
    ///
    /// # Errors
    /// When every triangle is degenerate, a coordinate is beyond 1e10 m, or the tree cannot be built.
    pub fn prepare(mesh: &TriangleMesh) -> Result<Self, PrepareError> {
        let start = Instant::now();
        let merged = mesh.merged().without_repeats().turned_alike();
        let Some((low, high)) = merged.bounding_box() else {
            return Err(PrepareError::Mesh(MeshError::Empty));
        };
        // Before merging, for an error to name the vertex as the file does.
        check_points(mesh.used_vertices())?;
        let used: Vec<Point3> = mesh.used_vertices().map(|(_, vertex)| *vertex).collect();
        let origin = nalgebra::center(&low, &high).coords;
        let vertices = merged.vertices().iter().map(|p| p - origin).collect();
        let merged = TriangleMesh::new(vertices, merged.triangles().to_vec())?;
        let Solids { triangles, is_solid, leads_out } = Solids::of(&merged);
        let merged = TriangleMesh::new(merged.vertices().to_vec(), triangles)?;
        let closed = merged.border_edges() == 0;
        let parts = parts(&merged);
        let watertight = merged.open_edges() == 0 && parts.iter().all(Part::has_inside);
        let has_solids = closed || is_solid.contains(&true);
        let surface = TriMesh::new(
            merged.vertices().iter().map(vector).collect(),
            merged.triangles().to_vec(),
        )
        .map_err(|error| PrepareError::Surface { reason: error.to_string() })?;
        let corner = |vertex: u32| merged.vertices()[vertex as usize];
        let missing = if closed { Vec::new() } else { merged.missing_triangles() };
        let missing = missing.into_iter().map(|of| of.map(corner)).collect();
        let triangles: Vec<_> = (0..merged.triangles().len()).map(|t| merged.corners(t)).collect();
        let tree = tree_of(triangles.iter().copied(), &searched())?;
        // What is open has no inside, and takes none away, but where there is nothing else.
        let counts = |triangle: &usize| closed || !has_solids || is_solid[*triangle];
        let (counting, rest): (Vec<_>, Vec<_>) = (0..triangles.len()).partition(counts);
        let winding_of =
            |some: Vec<usize>| Winding::new(some.iter().map(|&t| triangles[t]).collect());
        let sheets = (!rest.is_empty()).then(|| winding_of(rest));
        let winding = winding_of(counting);
        let prepare_time = start.elapsed();
        Ok(Self {
            origin,
            surface,
            tree,
            paper_tree: OnceLock::new(),
            winding,
            sheets,
            missing,
            vertices_of_parts: parts.iter().map(|part| part.vertex).collect(),
            watertight,
            closed,
            has_solids,
            leads_out,
            step: single_step(&used),
            cells: OnceLock::new(),
            samples: OnceLock::new(),
            prepare_time,
        })
    }

    /// Whether every edge joins two triangles, consistently turned, and every part encloses a
    /// volume, as a sheet with its own back face does not.
    pub fn is_watertight(&self) -> bool {
        self.watertight
    }

    /// What kind of surface it has, in a word or two: watertight, closed, partly closed or open.
    pub fn kind(&self) -> &'static str {
        match (self.watertight, self.closed, self.has_solids) {
            (true, ..) => "watertight",
            (false, true, _) => "closed",
            (false, false, true) => "partly closed",
            (false, false, false) => "open",
        }
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

    /// The surface as it was prepared, with merged vertices in the file frame, m.
    pub fn faces(&self) -> (Vec<Point3>, &[[u32; 3]]) {
        let in_file = |v: &Vector| Point3::new(v.x, v.y, v.z) + self.origin;
        (self.surface.vertices().iter().map(in_file).collect(), self.surface.indices())
    }

    /// Some thousand places on the surface in the local frame, m, each for the same area.
    pub(crate) fn samples(&self) -> &[Point3] {
        self.samples.get_or_init(|| self.spread(SAMPLES))
    }

    /// A vertex of each connected part, in the local frame, m.
    pub(crate) fn vertices_of_parts(&self) -> &[Point3] {
        &self.vertices_of_parts
    }

    /// Corners of the box around the surface, along the axes of the local frame, m.
    pub(crate) fn corners_of_box(&self) -> [Point3; 2] {
        let around = self.surface.local_aabb();
        [around.mins, around.maxs].map(|v| Point3::new(v.x, v.y, v.z))
    }

    /// Whether the normal of a triangle leads out of a part that has an inside.
    pub(crate) fn leads_out(&self, triangle: u32) -> bool {
        self.leads_out.get(triangle as usize).is_some_and(|&leads_out| leads_out)
    }

    /// Unit normal of a triangle, outward for a watertight mesh; `None` for a degenerate one.
    pub(crate) fn normal(&self, triangle: usize) -> Option<Vector3> {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(&(c - a)).try_normalize(0.0)
    }

    /// Whether its surface has no border, so that places inside are known to be: it may be watertight, or of
    /// closed parts that touch along edges, or part of it a sheet with its own back face.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Whether it has an inside: that of its closed parts.
    pub fn has_solids(&self) -> bool {
        self.has_solids
    }

    pub(crate) fn origin(&self) -> Vector3 {
        self.origin
    }

    pub(crate) fn tree(&self) -> &Tree {
        &self.tree
    }

    pub(crate) fn paper_tree(&self) -> &Tree {
        self.paper_tree.get_or_init(|| {
            let triangles = (0..self.triangle_count()).map(|t| self.corners(t));
            tree_of(triangles, &by_the_paper()).expect("another tree holds these triangles")
        })
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

/// How the tree that the default path searches is split.
fn searched() -> TreeSettings {
    TreeSettings {
        max_leaf_points: LEAF_TRIANGLES,
        min_leaf_points: 1,
        sibling_overlap: 0.0,
        split: Split::SurfaceArea,
        ..TreeSettings::default()
    }
}

/// The same for the paper's path.
fn by_the_paper() -> TreeSettings {
    let max_leaf_points = PAPER_LEAF_TRIANGLES;
    TreeSettings { max_leaf_points, min_leaf_points: 1, ..TreeSettings::default() }
}

fn tree_of(
    triangles: impl Iterator<Item = [Point3; 3]>,
    settings: &TreeSettings,
) -> Result<Tree, TreeError> {
    Tree::build(triangles.map(Primitive::Triangle).collect(), settings)
}

pub(super) fn vector(point: &Point3) -> Vector {
    Vector::new(point.x, point.y, point.z)
}
