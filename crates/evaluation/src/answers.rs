//! What was asked, what is true, and what each method said: one table for every sweep.

use std::fmt;
use std::time::Instant;

use anyhow::{Result, ensure};
use cloudtouch::{Clearance, ContactEvidence, Report};
use cloudtouch_testkit::family::Kind;

/// What the moving body is given as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pair {
    /// Two observed clouds.
    CloudCloud,
    /// An observed cloud and the exact mesh of the moving body, as a user gives a gripper.
    CloudMesh,
}

impl Pair {
    /// Both kinds.
    pub const ALL: [Self; 2] = [Self::CloudCloud, Self::CloudMesh];

    /// What belongs to this kind: the first to two clouds, the second to a cloud and a mesh.
    pub fn pick<T>(self, of_clouds: T, of_mesh: T) -> T {
        match self {
            Self::CloudCloud => of_clouds,
            Self::CloudMesh => of_mesh,
        }
    }
}

/// Its name in tables.
impl fmt::Display for Pair {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.pad(self.pick("cloud–cloud", "cloud–mesh"))
    }
}

/// How a scene was observed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition {
    /// Points of each cloud.
    pub points: usize,
    /// Standard deviation of the normal noise along each axis, m.
    pub std: f64,
}

/// One pose of one draw of a scene, and what is true there.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// Generator of the scene.
    pub family: &'static str,
    /// What that family is for.
    pub kind: Kind,
    /// What the moving body is given as.
    pub pair: Pair,
    /// How the scene was observed.
    pub condition: Condition,
    /// Number of the draw within its family: a scene, its poses, and fresh clouds.
    pub draw: u32,
    /// Number of the pose within its draw, the same under every condition.
    pub pose: u32,
    /// Whether the generating meshes intersect.
    pub collides: bool,
    /// Distance of the meshes, or minus their penetration depth, m.
    pub signed_distance: f64,
    /// Distance between neighbouring points of the sparser cloud that is asked about, m.
    pub spacing: f64,
}

/// What a method says of a question.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Said {
    /// Larger = more likely a collision; any monotone scale.
    pub score: f64,
    /// Collision probability, for a method that gives one.
    pub probability: Option<f64>,
    /// Lower and upper bound of the probability.
    pub bounds: Option<[f64; 2]>,
    /// What the probability rests on, for a method that tells.
    pub evidence: Option<ContactEvidence>,
    /// The distance of the surfaces, and a lower bound on it, m, for a method that tells.
    pub clearance: Option<Clearance>,
    /// See `clearance`.
    pub clearance_at_least: Option<f64>,
    /// Time of the query on prepared bodies, microseconds.
    pub micros: f64,
}

impl From<&Report> for Said {
    fn from(report: &Report) -> Self {
        Self {
            score: report.collision_probability,
            probability: Some(report.collision_probability),
            bounds: Some(report.bounds),
            evidence: report.evidence,
            clearance: report.clearance_m,
            clearance_at_least: report.clearance_at_least_m,
            micros: report.stats.query_us as f64,
        }
    }
}

impl Said {
    /// A score alone, since when it was sought.
    pub fn score(score: f64, start: Instant) -> Self {
        Self { score, micros: 1e6 * start.elapsed().as_secs_f64(), ..Self::default() }
    }

    fn is_sound(&self) -> bool {
        let is_unit = |p: f64| (0.0..=1.0).contains(&p);
        !self.score.is_nan()
            && self.probability.is_none_or(is_unit)
            && self.bounds.is_none_or(|[low, high]| is_unit(low) && is_unit(high) && low <= high)
    }
}

/// A question, and what every method says of it, in the order of their names; `None` where it was not
/// asked or has no answer.
pub type Row = (Question, Vec<Option<Said>>);

/// Questions with the answers of several methods.
#[derive(Debug)]
pub struct Answers {
    /// Names of the methods.
    pub methods: Vec<String>,
    /// All questions.
    pub rows: Vec<Row>,
}

impl Answers {
    /// Appends a question with its answers.
    ///
    /// # Errors
    /// When an answer is none: a NaN, a probability outside of [0, 1], bounds in the wrong order.
    pub fn push(&mut self, (question, said): Row) -> Result<()> {
        for (name, said) in self.methods.iter().zip(&said) {
            let is_sound = said.as_ref().is_none_or(Said::is_sound);
            ensure!(is_sound, "{name} on {question:?}: {said:?} is no answer");
        }
        self.rows.push((question, said));
        Ok(())
    }

    /// The families asked about, in the order of the questions.
    pub fn families(&self) -> Vec<&'static str> {
        let mut families: Vec<_> = self.rows.iter().map(|(question, _)| question.family).collect();
        // One is asked about after the other.
        families.dedup();
        families
    }

    /// Where the answers of a method stand in each row; `None` when there is no such method.
    pub fn index(&self, method: &str) -> Option<usize> {
        self.methods.iter().position(|name| name == method)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A question at 5,000 points and 5 mm.
    pub(crate) fn question(family: &'static str, draw: u32, pose: u32, collides: bool) -> Question {
        Question {
            family,
            kind: Kind::Ordinary,
            pair: Pair::CloudCloud,
            condition: Condition { points: 5_000, std: 0.005 },
            draw,
            pose,
            collides,
            signed_distance: if collides { -0.01 } else { 0.01 },
            spacing: 0.01,
        }
    }

    /// Nothing but these; all noise shows.
    pub(crate) fn evidence(deviations: f64, crossing: f64, noise: f64) -> ContactEvidence {
        ContactEvidence {
            deviations,
            crossing,
            extent: None,
            misclassified: None,
            noise_over_spacing: noise,
            scatter_over_spacing: noise,
        }
    }

    #[test]
    fn what_is_no_answer_is_refused() {
        let said = Said::score(0.0, Instant::now());
        for bad in [
            Said { score: f64::NAN, ..said },
            Said { probability: Some(1.01), ..said },
            Said { probability: Some(f64::NAN), ..said },
            Said { bounds: Some([0.6, 0.5]), ..said },
        ] {
            let mut answers = Answers { methods: vec!["x".into()], rows: Vec::new() };
            assert!(answers.push((question("a", 0, 0, true), vec![Some(bad)])).is_err());
            assert!(answers.rows.is_empty());
        }
    }
}
