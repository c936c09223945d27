//! What is drawn.

use cloudtouch::Mesh;
use cloudtouch::geom::Point3;

/// A scene or an object as it is drawn, in the frame of its file.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// As people know it, such as the name of its file.
    pub name: String,
    /// What it was taken for: how many points, which sensor.
    pub about: String,
    /// What is drawn of it.
    pub shape: Shape,
}

/// Points or triangles, m.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// The kept points of a cloud, in the order of its indices: reports name points by them.
    Cloud {
        /// One or more, m.
        points: Vec<Point3>,
        /// How bright the file shows each point, as many as points; drawn as a shade of grey, since
        /// colour stands for probability.
        brightness: Option<Vec<u8>>,
    },
    /// A mesh.
    Mesh {
        /// Corners, m.
        vertices: Vec<Point3>,
        /// Indices into the corners.
        triangles: Vec<[u32; 3]>,
    },
}

impl Shape {
    /// A cloud that `len` and `point` tell of, as those of both modes do.
    pub fn cloud(len: usize, point: impl Fn(usize) -> Point3) -> Self {
        Self::Cloud { points: (0..len).map(point).collect(), brightness: None }
    }

    /// The points, or corners.
    pub(crate) fn points(&self) -> &[Point3] {
        match self {
            Self::Cloud { points, .. } => points,
            Self::Mesh { vertices, .. } => vertices,
        }
    }
}

impl From<&cloudtouch::Body> for Shape {
    fn from(body: &cloudtouch::Body) -> Self {
        match body {
            cloudtouch::Body::Cloud(cloud) => Self::cloud(cloud.len(), |index| cloud.point(index)),
            cloudtouch::Body::Mesh(mesh) => (&**mesh).into(),
        }
    }
}

impl From<&Mesh> for Shape {
    fn from(mesh: &Mesh) -> Self {
        let (vertices, triangles) = mesh.faces();
        Self::Mesh { vertices, triangles: triangles.to_vec() }
    }
}
