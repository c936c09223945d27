//! Anything that can collide on the default path: a prepared cloud or a prepared mesh.

use std::sync::Arc;
use std::time::Duration;

use cloudtouch_geom::{Point3, Pose};

use crate::cloud::Cloud;
use crate::mesh::Mesh;
use crate::placement::{Placement, place};
use crate::shape::Shape;

/// A prepared cloud or mesh, owned.
#[derive(Debug)]
#[allow(
    clippy::large_enum_variant,
    reason = "a scene has a few bodies, each far larger on the heap"
)]
pub enum Body {
    /// A noisy cloud.
    Cloud(Cloud),
    /// An exact mesh; a filter that takes it out of scans ([`SelfMesh`](crate::SelfMesh)) may hold it too.
    Mesh(Arc<Mesh>),
}

/// A prepared cloud or mesh, borrowed: what a query takes.
#[derive(Debug, Clone, Copy)]
pub enum BodyRef<'a> {
    /// A noisy cloud.
    Cloud(&'a Cloud),
    /// An exact mesh.
    Mesh(&'a Mesh),
}

impl From<Cloud> for Body {
    fn from(cloud: Cloud) -> Self {
        Self::Cloud(cloud)
    }
}

impl From<Mesh> for Body {
    fn from(mesh: Mesh) -> Self {
        Self::Mesh(Arc::new(mesh))
    }
}

impl From<Arc<Mesh>> for Body {
    fn from(mesh: Arc<Mesh>) -> Self {
        Self::Mesh(mesh)
    }
}

impl From<Cloud> for Arc<Body> {
    fn from(cloud: Cloud) -> Self {
        Self::new(cloud.into())
    }
}

impl From<Mesh> for Arc<Body> {
    fn from(mesh: Mesh) -> Self {
        Self::new(mesh.into())
    }
}

impl<'a> From<&'a Cloud> for BodyRef<'a> {
    fn from(cloud: &'a Cloud) -> Self {
        Self::Cloud(cloud)
    }
}

impl<'a> From<&'a Mesh> for BodyRef<'a> {
    fn from(mesh: &'a Mesh) -> Self {
        Self::Mesh(mesh)
    }
}

impl<'a> From<&'a Body> for BodyRef<'a> {
    fn from(body: &'a Body) -> Self {
        match body {
            Body::Cloud(cloud) => Self::Cloud(cloud),
            Body::Mesh(mesh) => Self::Mesh(mesh),
        }
    }
}

/// What several threads hold.
macro_rules! from_shared {
    ($($of:ty),*) => {
        $(impl<'a> From<&'a Arc<$of>> for BodyRef<'a> {
            fn from(shared: &'a Arc<$of>) -> Self {
                Self::from(&**shared)
            }
        })*
    };
}

from_shared!(Body, Cloud, Mesh);

impl<'a> BodyRef<'a> {
    /// How long preparation took.
    pub fn prepare_time(&self) -> Duration {
        self.shape().prepare_time()
    }

    /// Where another body lies in this one at a pose from its file frame into that of this one. Takes
    /// about a millisecond.
    pub fn placement(&self, other: BodyRef<'_>, self_from_other: &Pose) -> Placement {
        place(self.shape(), other.shape(), self_from_other)
    }

    /// Lowest and highest corner of the box around its points along the axes of its file frame, m.
    pub fn corners(&self) -> [Point3; 2] {
        self.shape().corners().map(|corner| corner + self.shape().origin())
    }

    pub(crate) fn shape(&self) -> Shape<'a> {
        match *self {
            Self::Cloud(cloud) => Shape::Cloud(cloud.prepared()),
            Self::Mesh(mesh) => Shape::Mesh(mesh),
        }
    }
}
