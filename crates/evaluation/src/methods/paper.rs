//! The paper's algorithm at its default settings.

use anyhow::Result;
use cloudtouch::{Mesh, PaperCloud, PaperCloudSettings, PaperQuery, PaperSettings};
use cloudtouch_geom::Pose;
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

struct Bodies {
    query: PaperQuery,
    a: PaperCloud,
    b: PaperCloud,
    mesh: Mesh,
}

impl Method for Paper {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Box<dyn Prepared>> {
        let cloud = |seen: &Observation| {
            PaperCloud::prepare(&seen.cloud, &PaperCloudSettings::new(sensor_of(seen)))
        };
        Ok(Box::new(Bodies {
            query: PaperQuery::new(self.query)?,
            a: cloud(draw.a)?,
            b: cloud(draw.b)?,
            mesh: Mesh::prepare(draw.mesh)?,
        }))
    }
}

impl Prepared for Bodies {
    fn ask(&self, pair: Pair, a_from_b: &Pose) -> Result<Option<Said>> {
        let report = match pair {
            Pair::CloudCloud => self.query.run(&self.a, &self.b, a_from_b)?,
            Pair::CloudMesh => self.query.run(&self.a, &self.mesh, a_from_b)?,
        };
        Ok(Some(Said::from(&report)))
    }
}
