//! Ours: the default, with any setting changed, and the oracle.

use std::time::Instant;

use anyhow::Result;
use cloudtouch::{
    BodyRef, Cloud, DOUBT_KNOTS, Detail, Judge, MISCLASSIFIED_KNOTS, Mesh, Query, QuerySettings,
};
use cloudtouch_geom::{PointCloud, UnitVector3};
use cloudtouch_testkit::family::Observation;

use super::{Draw, Fitted, Method, Prepared, prepared};
use crate::answers::Said;

/// The query with some settings.
pub struct Ours {
    name: String,
    /// The judge is that fitted without the family asked about, unless all evidence is gathered for a new one.
    pub query: QuerySettings,
    /// Whether the surface is computed everywhere beforehand.
    is_refined: bool,
    /// Whether it is given the points without noise and the true normals.
    sees_truth: bool,
    fitted: Fitted,
    /// What is made of a fitted judge.
    alter: fn(Judge) -> Judge,
    /// What is asked: how likely the bodies are within this distance of each other, m.
    margin: f64,
}

impl Ours {
    /// The defaults.
    pub fn new(name: &str) -> Result<Self> {
        Ok(Self {
            name: name.to_owned(),
            query: QuerySettings::default(),
            is_refined: false,
            sees_truth: false,
            fitted: Fitted::stored()?,
            alter: |judge| judge,
            margin: 0.0,
        })
    }

    /// The default, given every sampled point as it truly is: what sampling alone leaves to be known.
    pub fn oracle(name: &str) -> Result<Self> {
        Ok(Self { sees_truth: true, ..Self::new(name)? })
    }

    /// The same, gathering all evidence however clear the first of it is.
    pub fn gathering_everything(mut self) -> Self {
        self.alter = |_| doubting();
        self.query.stop_above = 1.0;
        self
    }

    /// The same by geometry alone.
    pub fn without_classifier(self) -> Self {
        Self { alter: |judge| judge.without_classifier(), ..self }
    }

    /// The same, asked how likely the bodies are within a margin (m) of each other.
    pub fn within(self, margin: f64) -> Self {
        Self { margin, ..self }
    }

    /// The same, computing the surface of both clouds beforehand.
    pub fn refined(self) -> Self {
        Self { is_refined: true, ..self }
    }

    fn cloud(&self, observation: &Observation) -> Result<Cloud> {
        let seen = if self.sees_truth { &exact(observation) } else { observation };
        let cloud = prepared(seen)?;
        if self.is_refined { Ok(cloud.refined()?) } else { Ok(cloud) }
    }
}

/// The sampled points where they truly are, with the normals of the surface there; points that no
/// surface made are left out.
fn exact(observation: &Observation) -> Observation {
    let samples = || observation.truth.iter().flatten();
    let cloud = PointCloud {
        normals: Some(samples().map(|s| UnitVector3::new_normalize(s.normal)).collect()),
        ..PointCloud::from_points(samples().map(|s| s.position).collect())
    };
    Observation { cloud, truth: Vec::new(), std: 0.0 }
}

/// A judge that geometry leaves in doubt of everything, so that the classifier is asked everywhere.
fn doubting() -> Judge {
    let mut judge = Judge::default().without_extent().without_classifier();
    judge.by_geometry.as_flattened_mut().as_flattened_mut().fill(0.0);
    let middle = DOUBT_KNOTS.len() / 2;
    for (value, knot) in judge.revised[middle].iter_mut().zip(MISCLASSIFIED_KNOTS) {
        *value = 1e-3 * knot;
    }
    judge
}

impl Method for Ours {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared> {
        let judge = (self.alter)(self.fitted.to_judge(draw.family, self.sees_truth));
        let query = Query::new(QuerySettings { judge, ..self.query })?;
        let (a, b, margin) = (self.cloud(draw.a)?, self.cloud(draw.b)?, self.margin);
        let mesh = Mesh::prepare(draw.mesh)?;
        Ok(Box::new(move |pair, a_from_b| {
            let (moving, start) = (pair.pick(BodyRef::from(&b), (&mesh).into()), Instant::now());
            if query.settings().detail == Detail::Free {
                let is_free = query.is_free(&a, moving, a_from_b)?;
                return Ok(Some(Said::score(if is_free { 0.0 } else { 1.0 }, start)));
            }
            if margin == 0.0 {
                return Ok(Some(Said::from(&query.run(&a, moving, a_from_b)?)));
            }
            let (report, within) = query.within(&a, moving, a_from_b, margin)?;
            let mut said =
                Said { evidence: report.evidence, ..Said::score(within.deviations, start) };
            (said.probability, said.bounds) = (Some(within.probability), Some(within.bounds));
            Ok(Some(said))
        }))
    }
}
