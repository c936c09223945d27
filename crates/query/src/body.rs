//! Anything that can collide: a prepared cloud or a prepared mesh.

use std::time::Duration;

use cloudtouch_bvh::Tree;
use cloudtouch_geom::{Pose, Vector3};

use crate::{Cloud, Mesh};

/// A prepared cloud or mesh, owned.
#[derive(Debug)]
#[allow(
    clippy::large_enum_variant,
    reason = "a scene has a few bodies, each far larger on the heap"
)]
pub enum Body {
    /// A noisy cloud.
    Cloud(Cloud),
    /// An exact mesh.
    Mesh(Mesh),
}

/// A prepared cloud or mesh, borrowed: what a query takes.
#[derive(Debug, Clone, Copy)]
pub enum BodyRef<'a> {
    /// A noisy cloud.
    Cloud(&'a Cloud),
    /// An exact mesh.
    Mesh(&'a Mesh),
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

impl<'a> BodyRef<'a> {
    /// How long preparation took.
    pub fn prepare_time(&self) -> Duration {
        match self {
            Self::Cloud(cloud) => cloud.prepare_time(),
            Self::Mesh(mesh) => mesh.prepare_time(),
        }
    }

    /// How many points stand for the body: those of a cloud, the corners of a mesh.
    pub(crate) fn point_count(&self) -> usize {
        match self {
            Self::Cloud(cloud) => cloud.len(),
            Self::Mesh(mesh) => 3 * mesh.triangle_count(),
        }
    }

    pub(crate) fn origin(&self) -> Vector3 {
        match self {
            Self::Cloud(cloud) => cloud.origin(),
            Self::Mesh(mesh) => mesh.origin(),
        }
    }

    pub(crate) fn tree(&self) -> &'a Tree {
        match self {
            Self::Cloud(cloud) => cloud.tree(),
            Self::Mesh(mesh) => mesh.tree(),
        }
    }

    /// Maps the local frame of `other` into the local frame of `self`, given how their file
    /// frames relate. Large offsets cancel here, once, in double precision.
    pub(crate) fn local_from(&self, other: &Self, self_from_other: &Pose) -> Pose {
        Pose::from_translation(-self.origin())
            .after(self_from_other)
            .after(&Pose::from_translation(other.origin()))
    }
}
