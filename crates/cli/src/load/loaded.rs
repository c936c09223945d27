//! A body ready for queries, and what its files were taken for.

use anyhow::{Context, Result};
use serde::Serialize;

use crate::args::Refine;
use crate::body::{Body, PreparedCloud};

use super::geometry::Kind;

/// What a body is used as: only scenes are cleaned of the robot and turned into collision maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    Scene,
    Object,
}

/// A body and what it was taken for.
pub(crate) struct Loaded<C> {
    pub body: Body<C>,
    pub input: Input,
    /// What its files were taken for: of a body made of several scans, each of them.
    pub kinds: Vec<Kind>,
}

impl<C> Loaded<C> {
    pub(crate) fn is_mesh(&self) -> bool {
        matches!(self.body, Body::Mesh(_))
    }

    /// What its files are, each with what the body is used as.
    pub(crate) fn files(&self, role: Role) -> impl Iterator<Item = (Role, Kind)> {
        self.kinds.iter().map(move |kind| (role, *kind))
    }
}

impl<C: PreparedCloud> Loaded<C> {
    /// With the surface of a cloud computed everywhere, if that pays for so many poses.
    pub(crate) fn refined_for(self, poses: usize, refine: Refine) -> Result<Self> {
        Ok(match self.body {
            Body::Cloud(cloud) if refine.pays(cloud.count(), poses) => {
                let body = Body::Cloud(cloud.refined().with_context(|| self.input.file.clone())?);
                Self { body, ..self }
            }
            _ => self,
        })
    }
}

/// What a file was taken for: part of the answer, for slips to be seen.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Input {
    pub file: String,
    /// The same without folders, as a page names it.
    #[serde(skip)]
    pub short: String,
    /// In which its coordinates were taken.
    pub unit: String,
    /// By its spec; a mesh has none.
    pub sensor: Option<String>,
    /// Why it was chosen, where `auto` was asked for.
    pub sensor_because: Option<&'static str>,
}
