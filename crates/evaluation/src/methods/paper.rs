//! The paper's algorithm at its default settings.

use anyhow::Result;
use cloudtouch::{Mesh, PaperBodyRef, PaperCloud, PaperCloudSettings, PaperQuery, PaperSettings};
use cloudtouch_testkit::family::Observation;

use super::{Draw, Method, Prepared, sensor_of};
use crate::answers::{Pair, Said};

/// The query by the paper.
pub struct Paper {
    name: String,
    /// Settings of the query.
    pub query: PaperSettings,
}

impl Paper {
    /// The defaults.
    pub fn new(name: &str) -> Self {
        Self { name: name.to_owned(), query: PaperSettings::default() }
    }
}

impl Method for Paper {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared> {
        let cloud = |seen: &Observation| {
            PaperCloud::prepare(&seen.cloud, &PaperCloudSettings::new(sensor_of(seen)))
        };
        let query = PaperQuery::new(self.query)?;
        let (a, b, mesh) = (cloud(draw.a)?, cloud(draw.b)?, Mesh::prepare(draw.mesh)?);
        Ok(Box::new(move |pair, a_from_b| {
            let moving = match pair {
                Pair::CloudCloud => PaperBodyRef::from(&b),
                Pair::CloudMesh => PaperBodyRef::from(&mesh),
            };
            Ok(Some(Said::from(&query.run(&a, moving, a_from_b)?)))
        }))
    }
}
