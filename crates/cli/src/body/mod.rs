//! Prepared bodies of either path, and what the commands ask of both paths alike.

mod estimator;
mod estimators;
mod prepared_cloud;

use cloudtouch::{BodyRef, Cloud, Mesh, PaperBodyRef, PaperCloud};

pub(crate) use self::estimator::Estimator;
pub(crate) use self::prepared_cloud::PreparedCloud;

/// A cloud prepared for one of the paths, or a mesh.
#[allow(clippy::large_enum_variant, reason = "there are a few, each far larger on the heap")]
pub(crate) enum Body<C> {
    Cloud(C),
    Mesh(Mesh),
}

impl<'a> From<&'a Body<Cloud>> for BodyRef<'a> {
    fn from(body: &'a Body<Cloud>) -> Self {
        match body {
            Body::Cloud(cloud) => cloud.into(),
            Body::Mesh(mesh) => mesh.into(),
        }
    }
}

impl<'a> From<&'a Body<PaperCloud>> for PaperBodyRef<'a> {
    fn from(body: &'a Body<PaperCloud>) -> Self {
        match body {
            Body::Cloud(cloud) => cloud.into(),
            Body::Mesh(mesh) => mesh.into(),
        }
    }
}
