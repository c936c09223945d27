//! What was asked, what is true, and what each method said: one table for every sweep.

use std::{path::Path, time::Instant};

use anyhow::{Context, Result, ensure};
use cloudtouch::{ContactEvidence, Report};
use cloudtouch_io::write_atomically;
use serde::Serialize;

/// What the moving body is given as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pair {
    /// Two observed clouds.
    CloudCloud,
    /// An observed cloud and the exact mesh of the moving body, as a user gives a gripper.
    CloudMesh,
}

impl Pair {
    /// Both kinds.
    pub const ALL: [Self; 2] = [Self::CloudCloud, Self::CloudMesh];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::CloudCloud => "cloud–cloud",
            Self::CloudMesh => "cloud–mesh",
        }
    }
}

/// What a family of scenes is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// What users meet.
    Ordinary,
    /// Chosen to be hard.
    Adversarial,
    /// With meshes of real things, where their files are.
    Real,
}

/// How a scene was observed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Condition {
    /// Points of each cloud.
    pub points: usize,
    /// Standard deviation of the normal noise along each axis, m.
    pub std: f64,
}

/// One pose of one draw of a scene, and what is true there.
#[derive(Debug, Clone, PartialEq, Serialize)]
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Said {
    /// Larger = more likely a collision; any monotone scale.
    pub score: f64,
    /// Collision probability, for a method that gives one.
    pub probability: Option<f64>,
    /// Lower and upper bound of the probability.
    pub bounds: Option<[f64; 2]>,
    /// What the probability rests on, for a method that tells.
    pub evidence: Option<ContactEvidence>,
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
            micros: report.stats.query_us as f64,
        }
    }
}

impl Said {
    /// A score alone.
    pub fn score(score: f64, micros: f64) -> Self {
        Self { score, probability: None, bounds: None, evidence: None, micros }
    }

    /// Touching or not.
    pub fn yes_or_no(touch: bool, start: Instant) -> Self {
        Self::score(f64::from(u8::from(touch)), 1e6 * start.elapsed().as_secs_f64())
    }

    fn check(&self) -> Result<()> {
        let is_unit = |p: f64| (0.0..=1.0).contains(&p);
        let sound = !self.score.is_nan()
            && self.probability.is_none_or(is_unit)
            && self.bounds.is_none_or(|[low, high]| is_unit(low) && is_unit(high) && low <= high);
        ensure!(sound, "{self:?} is no answer");
        Ok(())
    }
}

/// Questions, and for every method its answers to them.
#[derive(Debug, Default)]
pub struct Answers {
    /// All questions.
    pub questions: Vec<Question>,
    /// Name of a method and its answers, one for each question; `None` where it was not asked.
    pub methods: Vec<(String, Vec<Option<Said>>)>,
}

impl Answers {
    /// Appends a question with the answers of some methods.
    ///
    /// # Errors
    /// When an answer is none: a NaN, a probability outside of [0, 1], bounds in the wrong order.
    pub fn push(&mut self, question: Question, said: &[(String, Said)]) -> Result<()> {
        let before = self.questions.len();
        for (name, said) in said {
            said.check().with_context(|| format!("{name} on {question:?}"))?;
            if !self.methods.iter().any(|(known, _)| known == name) {
                self.methods.push((name.clone(), vec![None; before]));
            }
        }
        for (name, answers) in &mut self.methods {
            answers.push(said.iter().find(|(n, _)| n == name).map(|(_, said)| *said));
        }
        self.questions.push(question);
        Ok(())
    }

    /// The families asked about, in the order of the questions.
    pub fn families(&self) -> Vec<&'static str> {
        let mut families = Vec::new();
        for question in &self.questions {
            if !families.contains(&question.family) {
                families.push(question.family);
            }
        }
        families
    }

    /// Names of the methods that answered.
    pub fn names(&self) -> Vec<&str> {
        self.methods.iter().map(|(name, _)| name.as_str()).collect()
    }

    /// Answers of a method; `None` when there is no such method.
    pub fn said(&self, method: &str) -> Option<&[Option<Said>]> {
        self.methods.iter().find(|(name, _)| name == method).map(|(_, said)| said.as_slice())
    }

    /// Writes a line of JSON for every answer.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        write_atomically(path, |out| {
            for (i, question) in self.questions.iter().enumerate() {
                for (method, said) in &self.methods {
                    let Some(said) = said[i] else { continue };
                    serde_json::to_writer(&mut *out, &Line { question, method, said })?;
                    out.write_all(b"\n")?;
                }
            }
            Ok(())
        })
        .with_context(|| format!("write {}", path.display()))
    }
}

#[derive(Serialize)]
struct Line<'a> {
    #[serde(flatten)]
    question: &'a Question,
    method: &'a str,
    #[serde(flatten)]
    said: Said,
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

    #[test]
    fn a_method_that_was_not_asked_has_no_answer() {
        let mut answers = Answers::default();
        let said = |p| Said { probability: Some(p), ..Said::score(p, 1.0) };
        answers.push(question("a", 0, 0, true), &[("x".into(), said(0.5))]).unwrap();
        let both = [("y".into(), said(0.2)), ("x".into(), said(0.1))];
        answers.push(question("b", 0, 0, true), &both).unwrap();
        assert_eq!(answers.said("x").unwrap().iter().flatten().count(), 2);
        assert_eq!(answers.said("y").unwrap()[0], None);
        assert_eq!(answers.said("y").unwrap()[1], Some(said(0.2)));
        assert_eq!(answers.families(), ["a", "b"]);
    }

    #[test]
    fn what_is_no_answer_is_refused() {
        let said = Said::score(0.0, 1.0);
        for bad in [
            Said { score: f64::NAN, ..said },
            Said { probability: Some(1.01), ..said },
            Said { probability: Some(f64::NAN), ..said },
            Said { bounds: Some([0.6, 0.5]), ..said },
        ] {
            let mut answers = Answers::default();
            assert!(answers.push(question("a", 0, 0, true), &[("x".into(), bad)]).is_err());
            assert!(answers.questions.is_empty());
        }
    }
}
