//! Runs the `cloudtouch` command and reads its JSON lines.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use anyhow::{Context, Result, bail};
use cloudtouch_geom::{Point3, Vector3};
use serde::Deserialize;

use super::case_file::CaseFile;

/// The command and how it came to be.
pub(super) struct Tool {
    binary: PathBuf,
    /// For the document: which build it is.
    pub(super) build: &'static str,
}

/// What the tool says of one case.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Answer {
    pub(super) collision_probability: f64,
    pub(super) bounds: [f64; 2],
    pub(super) verdict: String,
    pub(super) clearance_m: Option<Clearance>,
    pub(super) contacts: Vec<Contact>,
    pub(super) stats: Stats,
}

#[derive(Debug, Clone, Deserialize)]
pub(super) struct Clearance {
    pub(super) mean: f64,
    pub(super) std: f64,
}

#[derive(Debug, Clone, Deserialize)]
pub(super) struct Contact {
    point: [f64; 3],
    normal_a_to_b: [f64; 3],
    pub(super) probability: f64,
}

#[derive(Debug, Clone, Deserialize)]
pub(super) struct Stats {
    pub(super) prepare_us: u64,
    pub(super) query_us: u64,
}

impl Contact {
    pub(super) fn point(&self) -> Point3 {
        self.point.into()
    }

    /// Unit normal from scene to object.
    pub(super) fn normal(&self) -> Vector3 {
        self.normal_a_to_b.into()
    }
}

impl Answer {
    pub(super) fn query_ms(&self) -> f64 {
        self.stats.query_us as f64 / 1e3
    }

    pub(super) fn clearance_mm(&self) -> String {
        self.clearance_m
            .as_ref()
            .map_or("-".into(), |c| format!("{:+.1} ± {:.1}", 1e3 * c.mean, 1e3 * c.std))
    }
}

/// One line of a batch: a report, or an error.
#[derive(Deserialize)]
#[serde(untagged)]
enum Line {
    Error { id: String, error: String },
    Report(Box<Report>),
}

#[derive(Deserialize)]
struct Report {
    id: String,
    #[serde(flatten)]
    answer: Answer,
}

/// The answers of a batch, in the order of its cases.
pub(super) struct Batch {
    pub(super) answers: Vec<Result<Answer, String>>,
    /// The command as a reader would type it, with DIR for the data.
    pub(super) command: String,
}

impl Tool {
    /// The given binary, or one built now.
    pub(super) fn find(root: &Path, given: Option<&Path>) -> Result<Self> {
        if let Some(path) = given {
            let binary =
                path.canonicalize().with_context(|| format!("--tool {}", path.display()))?;
            return Ok(Self { binary, build: "a binary given with `--tool`" });
        }
        let cargo = || {
            let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
            cargo.current_dir(root);
            cargo
        };
        let package = ["--release", "--package", "cloudtouch-cli"];
        if !cargo().arg("build").args(package).status().context("start cargo")?.success() {
            bail!("cargo build {} failed", package.join(" "));
        }
        let metadata = cargo().args(["metadata", "--no-deps", "--format-version", "1"]).output()?;
        let metadata: serde_json::Value = serde_json::from_slice(&metadata.stdout)?;
        let target = metadata["target_directory"].as_str().context("no target_directory")?;
        let binary = Path::new(target)
            .join("release")
            .join(format!("cloudtouch{}", std::env::consts::EXE_SUFFIX));
        Ok(Self { binary, build: "`cargo build --release -p cloudtouch-cli`" })
    }

    /// Answers a case file on one thread; `shown` is how the document names it.
    pub(super) fn batch(
        &self,
        cases: &Path,
        shown: &str,
        lines: &Path,
        options: &[&str],
    ) -> Result<Batch> {
        // Lines of an earlier run must not pass for this one's.
        let _ = fs::remove_file(lines);
        // The status also says that some case has no answer; the lines tell which.
        let output = self
            .command("batch")
            .arg(cases)
            .args(options)
            .arg("--jsonl")
            .arg(lines)
            .output()
            .with_context(|| format!("start {}", self.binary.display()))?;
        let text = fs::read_to_string(lines).with_context(|| {
            format!("cloudtouch batch {shown}: {}", String::from_utf8_lossy(&output.stderr))
        })?;
        let expected = CaseFile::read(cases)?.cases;
        let mut answers = Vec::new();
        for (line, case) in text.lines().zip(&expected) {
            let line: Line = serde_json::from_str(line).with_context(|| format!("read {line}"))?;
            let (id, answer) = match line {
                Line::Error { id, error } => (id, Err(error)),
                Line::Report(report) => (report.id, Ok(report.answer)),
            };
            if id != case.id {
                bail!("the answer to case {} stands where that to {} should", id, case.id);
            }
            answers.push(answer);
        }
        if answers.len() != expected.len() {
            bail!("{} answers to {} cases", answers.len(), expected.len());
        }
        let command = format!("cloudtouch batch {shown} {}", options.join(" "));
        Ok(Batch { answers, command: command.trim_end().into() })
    }

    /// A command of the tool on one thread: times are then those of one core.
    pub(super) fn command(&self, name: &str) -> Command {
        let mut command = Command::new(&self.binary);
        command.arg(name).env("RAYON_NUM_THREADS", "1");
        command
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_a_report_or_an_error() {
        let report = r#"{"id":"a","collision_probability":0.5,"bounds":[0.4,0.6],
            "verdict":"in_contact","clearance_m":null,"contacts":[{"point":[1,2,3],
            "normal_a_to_b":[0,0,1],"probability":0.5,"clearance_m":0}],
            "stats":{"prepare_us":1,"query_us":1500,"more":0},"seed":0}"#;
        let Line::Report(report) = serde_json::from_str(report).unwrap() else { panic!() };
        assert_eq!((report.id.as_str(), report.answer.query_ms()), ("a", 1.5));
        assert_eq!(report.answer.contacts[0].point(), Point3::new(1.0, 2.0, 3.0));
        let error: Line = serde_json::from_str(r#"{"id":"b","error":"no"}"#).unwrap();
        assert!(matches!(error, Line::Error { id, error } if id == "b" && error == "no"));
    }
}
