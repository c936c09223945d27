//! The paper's algorithm, as printed and with our amendments.

use anyhow::Result;
use cloudtouch::{
    Mesh, PaperBodyRef, PaperCloud, PaperCloudSettings, PaperModel, PaperQuery, PaperSettings,
};
use cloudtouch_testkit::family::Observation;

use super::{Draw, Method, Prepared, sensor_of};
use crate::answers::Said;

/// The query by the paper.
pub struct Paper {
    name: String,
    /// Settings of the query.
    pub query: PaperSettings,
    model: PaperModel,
}

impl Paper {
    /// As printed.
    pub fn new(name: &str) -> Self {
        let (query, model) = (PaperSettings::default(), PaperModel::default());
        Self { name: name.to_owned(), query, model }
    }

    /// With all our amendments.
    pub fn amended(name: &str) -> Self {
        let (query, model) = (PaperSettings::amended(), PaperModel::amended());
        Self { name: name.to_owned(), query, model }
    }
}

impl Method for Paper {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared> {
        let cloud = |seen: &Observation| {
            let settings = PaperCloudSettings::new(sensor_of(seen));
            PaperCloud::prepare(&seen.cloud, &PaperCloudSettings { model: self.model, ..settings })
        };
        let query = PaperQuery::new(self.query)?;
        let (a, b, mesh) = (cloud(draw.a)?, cloud(draw.b)?, Mesh::prepare(draw.mesh)?);
        Ok(Box::new(move |pair, a_from_b| {
            let moving = pair.pick(PaperBodyRef::from(&b), PaperBodyRef::from(&mesh));
            Ok(Some(Said::from(&query.run(&a, moving, a_from_b)?)))
        }))
    }
}
