//! Anything that can collide on the paper's path.

use cloudtouch_bvh::Tree;
use cloudtouch_geom::Pose;

use crate::mesh::Mesh;
use crate::placement::{Placement, place};
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
    /// Where another body lies in this one at a pose from its file frame into that of this one. Takes
    /// about a millisecond.
    pub fn placement(&self, other: PaperBodyRef<'_>, self_from_other: &Pose) -> Placement {
        place(self.shape(), other.shape(), self_from_other)
    }

    pub(super) fn shape(&self) -> Shape<'a> {
        match *self {
            Self::Cloud(cloud) => Shape::Cloud(cloud.prepared()),
            Self::Mesh(mesh) => Shape::Mesh(mesh),
        }
    }
}

/// The tree that a body is searched by on this path.
pub(super) fn tree(shape: Shape<'_>) -> &Tree {
    match shape {
        Shape::Cloud(cloud) => cloud.tree(),
        Shape::Mesh(mesh) => mesh.paper_tree(),
    }
}
