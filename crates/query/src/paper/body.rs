//! Anything that can collide on the paper's path.

use crate::mesh::Mesh;
use crate::shape::Shape;

use super::cloud::PaperCloud;

/// A cloud prepared by the paper, or a mesh, borrowed: what a query by the paper takes.
#[derive(Debug, Clone, Copy)]
pub enum PaperBodyRef<'a> {
    /// A noisy cloud.
    Cloud(&'a PaperCloud),
    /// An exact mesh.
    Mesh(&'a Mesh),
}

impl<'a> From<&'a PaperCloud> for PaperBodyRef<'a> {
    fn from(cloud: &'a PaperCloud) -> Self {
        Self::Cloud(cloud)
    }
}

impl<'a> From<&'a Mesh> for PaperBodyRef<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Self::Mesh(mesh)
    }
}

impl<'a> PaperBodyRef<'a> {
    pub(super) fn shape(&self) -> Shape<'a> {
        match *self {
            Self::Cloud(cloud) => Shape::Cloud(cloud.prepared()),
            Self::Mesh(mesh) => Shape::Mesh(mesh),
        }
    }
}
