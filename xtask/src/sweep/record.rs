//! What was asked, what is true and what each method said.

use std::{fmt::Write as _, path::Path};

use anyhow::{Result, ensure};
use cloudtouch::{ContactEvidence, Report};
use cloudtouch_testkit::noise::NoiseKind;

use crate::common::files::write_whole;

/// Where a set of poses was answered.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Condition {
    /// Generator of the scene.
    pub(crate) family: &'static str,
    /// Points of both clouds.
    pub(crate) points: usize,
    /// How the noise is distributed.
    pub(crate) noise: NoiseKind,
    /// Standard deviation of the noise, m.
    pub(crate) std: f64,
}

/// A pose of that condition and what is true there.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Truth {
    /// Whether the generating meshes intersect.
    pub(crate) collides: bool,
    /// Distance of the meshes, or minus their penetration depth, m.
    pub(crate) signed_distance: f64,
}

/// What a method says of a pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Said {
    /// Larger = more likely a collision; any monotone scale.
    pub(crate) score: f64,
    /// Collision probability, for a method that gives one.
    pub(crate) probability: Option<f64>,
    /// Lower and upper bound of the probability.
    pub(crate) bounds: Option<[f64; 2]>,
    /// What the probability rests on, for a method that tells.
    pub(crate) evidence: Option<ContactEvidence>,
    /// Time of the query, microseconds.
    pub(crate) micros: f64,
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

/// The poses of one condition with the answers of every method.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    pub(crate) condition: Condition,
    /// Number of each pose within its family: the same number is the same pose in every
    /// condition, so that its answers are not taken for independent ones.
    pub(crate) poses: Vec<u32>,
    pub(crate) truths: Vec<Truth>,
    /// Name of a method, and one answer for each pose.
    pub(crate) methods: Vec<(String, Vec<Said>)>,
}

impl Block {
    /// What a method says of each pose; `None` when it did not answer.
    pub(crate) fn said(&self, method: &str) -> Option<&[Said]> {
        self.methods.iter().find(|(name, _)| name == method).map(|(_, said)| said.as_slice())
    }
}

/// All answers of a sweep, one block for each condition.
#[derive(Debug, Clone, Default)]
pub(crate) struct Answers {
    blocks: Vec<Block>,
}

impl Answers {
    /// Takes the answers to one condition.
    ///
    /// # Errors
    ///
    /// When a list has not one entry for each pose, or an answer is no answer (a NaN score, a
    /// probability outside of [0, 1], bounds in the wrong order).
    pub(crate) fn add(&mut self, block: Block) -> Result<()> {
        let family = block.condition.family;
        let count = block.truths.len();
        ensure!(
            block.poses.len() == count,
            "{family}: {count} truths but {} pose numbers",
            block.poses.len()
        );
        for (method, said) in &block.methods {
            ensure!(
                said.len() == count,
                "{family}, {method}: {} answers to {count} poses",
                said.len()
            );
            for (pose, said) in block.poses.iter().zip(said) {
                ensure!(is_answer(said), "{family}, pose {pose}, {method}: {said:?} is no answer");
            }
        }
        self.blocks.push(block);
        Ok(())
    }

    /// The blocks in the order in which they were added.
    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// The families, each once, in the order of the blocks.
    pub(crate) fn families(&self) -> Vec<&'static str> {
        let mut families = Vec::new();
        for block in &self.blocks {
            if !families.contains(&block.condition.family) {
                families.push(block.condition.family);
            }
        }
        families
    }

    /// The blocks, to fill in what is derived from all of them.
    pub(super) fn blocks_mut(&mut self) -> &mut [Block] {
        &mut self.blocks
    }

    /// Writes one row for each condition, pose and method; missing values are empty cells.
    ///
    /// # Errors
    ///
    /// When the file cannot be written.
    pub(crate) fn write_csv(&self, path: &Path) -> Result<()> {
        write_whole(path, self.csv())
    }

    fn csv(&self) -> String {
        let mut text = String::from(
            "family,points,noise,std_m,pose,collides,signed_distance_m,method,score,probability,\
             probability_low,probability_high,deviations,crossing,misclassified,micros\n",
        );
        for block in &self.blocks {
            let Condition { family, points, noise, std } = &block.condition;
            for (i, (truth, pose)) in block.truths.iter().zip(&block.poses).enumerate() {
                for (method, said) in &block.methods {
                    let Truth { collides, signed_distance } = truth;
                    let Said { score, probability, bounds, evidence, micros } = said[i];
                    let [low, high] = bounds.map_or([None; 2], |b| b.map(Some)).map(cell);
                    let probability = cell(probability);
                    let [z, crossing, misclassified] = evidence_cells(evidence);
                    // Writing to a string cannot fail.
                    let _ = writeln!(
                        text,
                        "{family},{points},{},{std},{pose},{collides},{signed_distance},{},\
                         {score},{probability},{low},{high},{z},{crossing},{misclassified},{micros}",
                        noise_name(*noise),
                        quoted(method),
                    );
                }
            }
        }
        text
    }
}

/// The word for a distribution of noise in files and legends.
pub(crate) fn noise_name(kind: NoiseKind) -> &'static str {
    match kind {
        NoiseKind::Gaussian => "gaussian",
        NoiseKind::HeavyTailed => "heavy-tailed",
    }
}

/// A cell of a CSV file, in quotes where it has to be (RFC 4180).
pub(crate) fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

fn cell(value: Option<f64>) -> String {
    value.map_or(String::new(), |v| v.to_string())
}

fn evidence_cells(evidence: Option<ContactEvidence>) -> [String; 3] {
    let Some(evidence) = evidence else { return Default::default() };
    let ContactEvidence { deviations, crossing, misclassified } = evidence;
    [Some(deviations), Some(crossing), misclassified].map(cell)
}

fn is_answer(said: &Said) -> bool {
    let unit = 0.0..=1.0;
    !said.score.is_nan()
        && said.probability.is_none_or(|p| unit.contains(&p))
        && said
            .bounds
            .is_none_or(|[low, high]| unit.contains(&low) && unit.contains(&high) && low <= high)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: Said = Said {
        score: 1.5,
        probability: Some(0.25),
        bounds: Some([0.0, 0.5]),
        evidence: None,
        micros: 12.5,
    };

    fn block(method: &str, said: Vec<Said>) -> Block {
        Block {
            condition: Condition {
                family: "boxes",
                points: 2500,
                noise: NoiseKind::Gaussian,
                std: 0.005,
            },
            poses: vec![7],
            truths: vec![Truth { collides: true, signed_distance: -0.01 }],
            methods: vec![(method.to_owned(), said)],
        }
    }

    #[test]
    fn the_file_has_a_row_for_each_answer() {
        let mut answers = Answers::default();
        answers.add(block("ours", vec![GOOD])).unwrap();
        let bare = Said { probability: None, bounds: None, ..GOOD };
        answers.add(block("boxes, 1 cm", vec![bare])).unwrap();
        let csv = answers.csv();
        let rows: Vec<&str> = csv.lines().skip(1).collect();
        assert_eq!(
            rows,
            [
                "boxes,2500,gaussian,0.005,7,true,-0.01,ours,1.5,0.25,0,0.5,,,,12.5",
                "boxes,2500,gaussian,0.005,7,true,-0.01,\"boxes, 1 cm\",1.5,,,,,,,12.5",
            ]
        );
        let columns = csv.lines().next().unwrap().split(',').count();
        assert_eq!(columns, rows[0].split(',').count());
    }

    #[test]
    fn what_is_no_answer_is_refused() {
        let mut answers = Answers::default();
        for (said, named) in [
            (vec![], "0 answers to 1 poses"),
            (vec![Said { score: f64::NAN, ..GOOD }], "pose 7"),
            (vec![Said { probability: Some(1.01), ..GOOD }], "no answer"),
            (vec![Said { probability: Some(f64::NAN), ..GOOD }], "no answer"),
            (vec![Said { bounds: Some([0.6, 0.5]), ..GOOD }], "no answer"),
        ] {
            let error = answers.add(block("ours", said)).unwrap_err().to_string();
            assert!(error.contains(named), "{error}");
        }
        let unnumbered = Block { poses: vec![], ..block("ours", vec![GOOD]) };
        assert!(answers.add(unnumbered).is_err());
        assert!(answers.blocks().is_empty());
    }
}
