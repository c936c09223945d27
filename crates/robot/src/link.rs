//! What a link is made of, as meshes in its frame.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use cloudtouch::geom::{MeshError, Point3, TriangleMesh, Vector3};
use cloudtouch::{Body, Mesh};
use cloudtouch_io::{LengthUnit, ReadLimits, read_mesh_within};
use urdf_rs::Geometry;

use crate::error::RobotFault;
use crate::joint::{finite, pose};
use crate::primitive;
use crate::uri::locate;

/// One `<collision>` element of a link.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    /// By its place among the links.
    pub link: usize,
    /// In the frame of the link, m.
    pub triangles: TriangleMesh,
    /// The same, prepared: for filters of scans, ...
    pub mesh: Arc<Mesh>,
    /// ... and for scenes.
    pub body: Arc<Body>,
    /// What it was made from, if that was a file.
    pub uri: Option<String>,
    /// No point of it is farther from the origin of the link, m.
    pub radius: f64,
}

/// Where files are, and how large they may be.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sources<'a> {
    pub folder: &'a Path,
    pub packages: &'a [(String, PathBuf)],
    pub limits: &'a ReadLimits,
}

impl Shape {
    pub(crate) fn try_from_urdf(
        (link, name): (usize, &str),
        collision: &urdf_rs::Collision,
        sources: Sources<'_>,
    ) -> Result<Self, RobotFault> {
        let link_from_shape = pose(&collision.origin, &format!("link `{name}`"))?;
        let (triangles, uri) = triangles(name, &collision.geometry, sources)?;
        let what = uri.clone().unwrap_or_else(|| "a primitive".to_owned());
        let refused = |error| RobotFault::prepare(name, &what, error);
        let at = |p: &Point3| link_from_shape.transform_point(p);
        let vertices: Vec<Point3> = triangles.vertices().iter().map(at).collect();
        let triangles = TriangleMesh::new(vertices, triangles.triangles().to_vec())
            .map_err(|e| refused(e.into()))?;
        let radius = triangles.used_vertices().map(|(_, p)| p.coords.norm()).fold(0.0, f64::max);
        let mesh = Arc::new(Mesh::prepare(&triangles).map_err(refused)?);
        let body = Arc::new(Body::from(Arc::clone(&mesh)));
        Ok(Self { link, triangles, mesh, body, uri, radius })
    }

    /// Diagonal of its box, m.
    pub(crate) fn size(&self) -> f64 {
        self.triangles.bounding_box().map_or(0.0, |(low, high)| (high - low).norm())
    }
}

/// In the frame of the geometry, and the file they are from.
fn triangles(
    link: &str,
    geometry: &Geometry,
    sources: Sources<'_>,
) -> Result<(TriangleMesh, Option<String>), RobotFault> {
    let size = |value: f64, what: &'static str| {
        let is_size = value > 0.0 && value.is_finite();
        let link = link.to_owned();
        if is_size { Ok(value) } else { Err(RobotFault::Size { link, what, value }) }
    };
    let (made, uri) = match geometry {
        Geometry::Box { size: sides } => {
            sides.0.iter().try_for_each(|&side| size(side, "box size").map(|_| ()))?;
            (primitive::cuboid(sides.0), None)
        }
        Geometry::Cylinder { radius, length } => {
            let radius = size(*radius, "cylinder radius")?;
            (primitive::cylinder(radius, size(*length, "cylinder length")?), None)
        }
        Geometry::Capsule { radius, length } => {
            let radius = size(*radius, "capsule radius")?;
            (primitive::capsule(radius, size(*length, "capsule length")?), None)
        }
        Geometry::Sphere { radius } => (primitive::sphere(size(*radius, "sphere radius")?), None),
        Geometry::Mesh { filename, scale } => {
            let path = locate(link, filename, sources.folder, sources.packages)?;
            let read = read_mesh_within(&path, LengthUnit::Metres, sources.limits);
            let mesh = read.map_err(|error| RobotFault::Mesh { link: link.to_owned(), error })?;
            let scale = finite(&scale.map_or([1.0; 3], |scale| scale.0), link, "mesh scale")?;
            if let Some(&value) = scale.iter().find(|value| **value == 0.0) {
                let link = link.to_owned();
                return Err(RobotFault::Size { link, what: "mesh scale", value });
            }
            (scaled(&mesh, scale), Some(filename.clone()))
        }
    };
    let what = uri.as_deref().unwrap_or("a primitive");
    let made = made.map_err(|error| RobotFault::prepare(link, what, error))?;
    Ok((made, uri))
}

/// Scaled along each axis; a mirrored mesh keeps its outside out.
fn scaled(mesh: &TriangleMesh, scale: [f64; 3]) -> Result<TriangleMesh, MeshError> {
    let scale = Vector3::from(scale);
    let vertices = mesh.vertices().iter().map(|p| Point3::from(p.coords.component_mul(&scale)));
    let mirrors = scale.iter().product::<f64>() < 0.0;
    let turned = |&[a, b, c]: &[u32; 3]| if mirrors { [a, c, b] } else { [a, b, c] };
    TriangleMesh::new(vertices.collect(), mesh.triangles().iter().map(turned).collect())
}
