//! Forty labelled poses in real scans, asked of the tool: clear cases must be answered clearly.

use std::path::Path;

use anyhow::{Result, ensure};
use serde_json::Value;

use super::{
    cases::{self, Labelled, file_name},
    tool,
};
use crate::{
    page::Section,
    statistics::quantile,
    table::{Table, bounds, probability},
};

/// The sensor of each scan, by a part of its file name.
const SENSORS: [&str; 5] = [
    "mug=iso:0.005",
    "mosd=kinect",
    "template=kinect",
    "samp11=axes:0.3,0.3,0.15",
    "room_scan=lidar:0.02,0.003",
];
const LABELS: [&str; 5] = ["free", "near", "contact", "shallow", "collision"];
const VERDICTS: [&str; 4] = ["free", "in contact", "in collision", "undecided"];
/// A free case must stay below, a deep one above.
const FREE_BELOW: f64 = 0.1;
const COLLISION_ABOVE: f64 = 0.9;

/// What the tool says of one case, or its error.
type Answer = Result<Said, String>;

#[derive(Debug)]
struct Said {
    p: f64,
    bounds: [f64; 2],
    verdict: String,
    /// Mean and standard deviation, mm; a dash where it is not told.
    clearance: String,
    prepare_ms: f64,
    query_ms: f64,
}

pub(super) fn evaluate(root: &Path, data: &Path) -> Result<(Section, Vec<String>)> {
    let path = data.join("cases.json");
    let cases = cases::read(&path)?;
    let options: Vec<&str> = SENSORS.iter().flat_map(|spec| ["--sensor-for", spec]).collect();
    let lines = tool::batch(root, &path, &options)?;
    ensure!(lines.len() == cases.len(), "{} answers to {} cases", lines.len(), cases.len());
    for (line, case) in lines.iter().zip(&cases) {
        let id = &line["id"];
        ensure!(*id == *case.id, "the answer to {id} stands where that to {} should", case.id);
    }
    let answers: Vec<Answer> = lines.iter().map(read).collect();
    let all = || cases.iter().zip(&answers);
    let failures: Vec<String> = all().filter_map(|(case, answer)| failure(case, answer)).collect();
    let checked = cases.iter().filter(|case| wanted(case).is_some()).count();
    let said: Vec<(&Labelled, &Said)> =
        all().filter_map(|(case, answer)| Some((case, answer.as_ref().ok()?))).collect();
    let prepare: Vec<f64> = said.iter().map(|(_, said)| said.prepare_ms).collect();
    let text = format!(
        "{} of {} cases answered by the tool. Checked: every `free` case has P < {FREE_BELOW}, \
         every `collision` case that is deep (basis `depth`) has P > {COLLISION_ABOVE}; {} of \
         {checked} hold. The other labels are not checked: they describe the measured points, not \
         the surface behind them. The smallest distance is that of the single worst raw point. \
         Query times are those of one thread; preparing scene and object, once for all their \
         queries, took {:.0} ms (median).",
        said.len(),
        cases.len(),
        checked - failures.len().min(checked),
        quantile(&prepare, 0.5),
    );
    let section = Section::new("Labelled poses in real scans")
        .text(text)
        .text(by_label(&said))
        .text(each(&cases, &answers))
        .text(format!("```text\ncloudtouch batch DIR/cases.json {}\n```", options.join(" ")));
    Ok((section, failures))
}

/// One line of the tool's JSON: a report, or an error.
fn read(line: &Value) -> Answer {
    if let Some(error) = line["error"].as_str() {
        return Err(error.to_owned());
    }
    // What is missing is NaN, which no check lets through.
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let clearance = &line["clearance_m"];
    Ok(Said {
        p: number(&line["collision_probability"]),
        bounds: [0, 1].map(|end| number(&line["bounds"][end])),
        verdict: line["verdict"].as_str().unwrap_or("none").replace('_', " "),
        clearance: if clearance.is_null() {
            "-".to_owned()
        } else {
            let [mean, std] = ["mean", "std"].map(|name| 1e3 * number(&clearance[name]));
            format!("{mean:+.1} ± {std:.1}")
        },
        prepare_ms: 1e-3 * number(&line["stats"]["prepare_us"]),
        query_ms: 1e-3 * number(&line["stats"]["query_us"]),
    })
}

/// The probabilities between which the answer to a clear case must lie.
fn wanted(case: &Labelled) -> Option<[f64; 2]> {
    match (case.label.as_str(), case.basis.as_str()) {
        ("free", _) => Some([0.0, FREE_BELOW]),
        ("collision", "depth") => Some([COLLISION_ABOVE, 1.0]),
        _ => None,
    }
}

/// What is wrong with the answer: of any case that it is missing or contradicts its bounds, of a
/// clear one also that it is not clear.
fn failure(case: &Labelled, answer: &Answer) -> Option<String> {
    let id = &case.id;
    let (p, [low, high]) = match answer {
        Ok(said) => (said.p, said.bounds),
        Err(error) => return Some(format!("{id}: no answer: {error}")),
    };
    if !(low <= p && p <= high) {
        return Some(format!("{id}: P {p} is not within its bounds {low} .. {high}"));
    }
    let [least, most] = wanted(case)?;
    // Strictly inside; NaN is not.
    let inside = (p > least || least == 0.0) && (p < most || most == 1.0);
    (!inside).then(|| format!("{id}: P {} of a {} case", probability(p), case.label))
}

fn by_label(answered: &[(&Labelled, &Said)]) -> Table {
    let mut header = vec!["label", "cases", "P min", "P median", "P max"];
    header.extend(VERDICTS);
    header.extend(["query median (ms)", "query p95 (ms)"]);
    let mut table = Table::new(header);
    for label in LABELS {
        let of: Vec<&Said> = answered
            .iter()
            .filter(|(case, _)| case.label == label)
            .map(|(_, said)| *said)
            .collect();
        let p: Vec<f64> = of.iter().map(|said| said.p).collect();
        let time: Vec<f64> = of.iter().map(|said| said.query_ms).collect();
        let mut cells = vec![label.to_owned(), of.len().to_string()];
        cells.extend([0.0, 0.5, 1.0].map(|q| probability(quantile(&p, q))));
        cells.extend(
            VERDICTS.map(|verdict| of.iter().filter(|s| s.verdict == verdict).count().to_string()),
        );
        cells.extend([0.5, 0.95].map(|q| format!("{:.1}", quantile(&time, q))));
        table.row(cells);
    }
    table
}

fn each(cases: &[Labelled], answers: &[Answer]) -> Table {
    let mut table = Table::new([
        "case",
        "label (basis)",
        "smallest distance (mm)",
        "P",
        "bounds",
        "verdict",
        "clearance (mm)",
        "query (ms)",
        "scene / object",
    ]);
    for (case, answer) in cases.iter().zip(answers) {
        let mut cells = vec![
            case.id.clone(),
            format!("{} ({})", case.label, case.basis),
            format!("{:+.1}", 1e3 * case.distance),
        ];
        cells.extend(match answer {
            Ok(said) => [
                probability(said.p),
                bounds(said.bounds),
                said.verdict.clone(),
                said.clearance.clone(),
                format!("{:.1}", said.query_ms),
            ],
            Err(_) => ["no answer", "-", "-", "-", "-"].map(String::from),
        });
        cells.push(format!("{} / {}", file_name(&case.scene), file_name(&case.object)));
        table.row(cells);
    }
    table
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;
    use serde_json::json;

    use super::*;

    fn failure_of(label: &str, basis: &str, line: &Value) -> Option<String> {
        let case = Labelled {
            id: "x".to_owned(),
            scene: "s".into(),
            object: "o".into(),
            scene_from_object: Pose::identity(),
            label: label.to_owned(),
            basis: basis.to_owned(),
            distance: 0.0,
            advance: None,
            in_series: false,
        };
        failure(&case, &read(line))
    }

    #[test]
    fn clear_cases_need_clear_answers_and_all_need_sound_ones() {
        let line = |p: f64, bounds: [f64; 2]| json!({"collision_probability": p, "bounds": bounds});
        assert_eq!(failure_of("free", "distance", &line(0.0, [0.0, 0.1])), None);
        assert_eq!(failure_of("collision", "depth", &line(1.0, [0.9, 1.0])), None);
        assert_eq!(failure_of("collision", "advance", &line(0.3, [0.0, 1.0])), None);
        assert!(failure_of("free", "distance", &line(0.1, [0.0, 0.1])).is_some());
        assert!(failure_of("collision", "depth", &line(0.9, [0.9, 1.0])).is_some());
        // Whatever the label.
        assert!(failure_of("contact", "distance", &line(0.5, [0.6, 0.7])).is_some());
        assert!(failure_of("contact", "distance", &json!({"error": "no"})).is_some());
        assert!(failure_of("contact", "distance", &json!({})).is_some());
    }
}
