//! Forty labelled poses in real scans: clear cases must be answered clearly.

use std::fmt::Write as _;

use anyhow::Result;

use super::{
    Places, Section,
    case_file::{Case, CaseFile},
    tool::{Answer, Tool},
};
use crate::common::{
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
/// A free case must stay below, a deep one above.
const FREE_BELOW: f64 = 0.1;
const COLLISION_ABOVE: f64 = 0.9;

pub(super) fn evaluate(tool: &Tool, places: &Places) -> Result<Section> {
    let path = places.data.join("cases.json");
    let cases = CaseFile::read(&path)?.cases;
    let options: Vec<&str> = SENSORS.iter().flat_map(|spec| ["--sensor-for", spec]).collect();
    let lines = places.work.join("real-scans.jsonl");
    let batch = tool.batch(&path, "DIR/cases.json", &lines, &options)?;
    let answered: Vec<(&Case, &Answer)> = cases
        .iter()
        .zip(&batch.answers)
        .filter_map(|(case, answer)| Some((case, answer.as_ref().ok()?)))
        .collect();
    let failures: Vec<String> =
        cases.iter().zip(&batch.answers).filter_map(|(c, a)| failure(c, a)).collect();
    let checked = cases.iter().filter(|case| wanted(case).is_some()).count();

    let mut text = format!(
        "{} of {} cases answered. Checked: every `free` case has P < {FREE_BELOW}, every \
         `collision` case that is deep (basis `depth`) has P > {COLLISION_ABOVE}; {} of {checked} \
         hold. The other labels are not checked: they describe the measured points, not the \
         surface behind them. The smallest signed distance is that of the single worst raw point.\n\n",
        answered.len(),
        cases.len(),
        checked - failures.len().min(checked),
    );
    writeln!(text, "{}", by_label(&answered))?;
    let milliseconds = |of: fn(&Answer) -> u64| -> Vec<f64> {
        answered.iter().map(|(_, answer)| of(answer) as f64 / 1e3).collect()
    };
    let query = milliseconds(|a| a.stats.query_us);
    let prepare = milliseconds(|a| a.stats.prepare_us);
    writeln!(
        text,
        "Query: median {:.1} ms, 95th percentile {:.1} ms. Preparation of scene and object, once \
         for all their queries: median {:.0} ms, 95th percentile {:.0} ms.\n",
        quantile(&query, 0.5),
        quantile(&query, 0.95),
        quantile(&prepare, 0.5),
        quantile(&prepare, 0.95),
    )?;
    writeln!(text, "{}", each(&cases, &batch.answers))?;
    Ok(Section {
        title: "Labelled poses in real scans".into(),
        text,
        commands: vec![batch.command],
        failures,
    })
}

/// The probabilities between which the answer to a clear case must lie.
fn wanted(case: &Case) -> Option<[f64; 2]> {
    match (case.label.as_deref(), case.label_basis.as_deref()) {
        (Some("free"), _) => Some([0.0, FREE_BELOW]),
        (Some("collision"), Some("depth")) => Some([COLLISION_ABOVE, 1.0]),
        _ => None,
    }
}

/// What is wrong with the answer: of any case that it is missing or contradicts its bounds, of a
/// clear one also that it is not clear.
fn failure(case: &Case, answer: &Result<Answer, String>) -> Option<String> {
    let id = &case.id;
    let answer = match answer {
        Ok(answer) => answer,
        Err(error) => return Some(format!("{id}: no answer: {error}")),
    };
    let p = answer.collision_probability;
    let [low, high] = answer.bounds;
    if !(low <= p && p <= high) {
        return Some(format!("{id}: P {p} is not within its bounds {low} .. {high}"));
    }
    let [least, most] = wanted(case)?;
    let label = case.label.as_deref().unwrap_or_default();
    // Strictly inside; NaN is not.
    let inside = (p > least || least == 0.0) && (p < most || most == 1.0);
    (!inside).then(|| format!("{id}: P {} of a {label} case", probability(p)))
}

fn by_label(answered: &[(&Case, &Answer)]) -> Table {
    let mut table = Table::new(&[
        "label",
        "cases",
        "P min",
        "P median",
        "P max",
        "free",
        "in contact",
        "in collision",
        "undecided",
        "query median (ms)",
        "query p95 (ms)",
    ]);
    for label in LABELS {
        let of: Vec<&Answer> = answered
            .iter()
            .filter(|(case, _)| case.label.as_deref() == Some(label))
            .map(|(_, answer)| *answer)
            .collect();
        let p: Vec<f64> = of.iter().map(|a| a.collision_probability).collect();
        let time: Vec<f64> = of.iter().map(|a| a.query_ms()).collect();
        let verdicts = ["free", "in_contact", "in_collision", "undecided"]
            .map(|verdict| of.iter().filter(|a| a.verdict == verdict).count().to_string());
        let [least, middle, most] = [0.0, 0.5, 1.0].map(|q| probability(quantile(&p, q)));
        let times = [0.5, 0.95].map(|q| format!("{:.1}", quantile(&time, q)));
        let start = [label.into(), of.len().to_string(), least, middle, most];
        table.row(start.into_iter().chain(verdicts).chain(times));
    }
    table
}

fn each(cases: &[Case], answers: &[Result<Answer, String>]) -> Table {
    let mut table = Table::new(&[
        "case",
        "label",
        "basis",
        "smallest distance (mm)",
        "P",
        "bounds",
        "verdict",
        "clearance (mm)",
        "query (ms)",
        "scene",
        "object",
    ]);
    let file = |path: &str| path.rsplit('/').next().unwrap_or_default().to_owned();
    for (case, answer) in cases.iter().zip(answers) {
        let distance = case.measured.as_ref().map(|m| 1e3 * m.min_signed_distance_m);
        let mut cells = vec![
            case.id.clone(),
            case.label.clone().unwrap_or_default(),
            case.label_basis.clone().unwrap_or_default(),
            distance.map_or("-".into(), |d| format!("{d:+.1}")),
        ];
        match answer {
            Ok(answer) => cells.extend([
                probability(answer.collision_probability),
                bounds(answer.bounds),
                answer.verdict.replace('_', " "),
                answer.clearance_mm(),
                format!("{:.1}", answer.query_ms()),
            ]),
            Err(_) => cells.extend(["no answer", "-", "-", "-", "-"].map(String::from)),
        }
        cells.extend([file(&case.scene), file(&case.object)]);
        table.row(cells);
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn failure_of(label: &str, basis: &str, p: f64, bounds: [f64; 2]) -> Option<String> {
        let pose = [[0.0; 4]; 4];
        let case = serde_json::from_value(serde_json::json!({
            "id": "x", "scene": "s", "object": "o", "pose": pose,
            "label": label, "label_basis": basis,
        }));
        let answer = serde_json::from_value(serde_json::json!({
            "collision_probability": p, "bounds": bounds, "verdict": "free", "clearance_m": null,
            "contacts": [], "stats": {"prepare_us": 0, "query_us": 0},
        }));
        failure(&case.unwrap(), &Ok(answer.unwrap()))
    }

    #[test]
    fn clear_cases_need_clear_answers() {
        assert_eq!(failure_of("free", "distance", 0.0, [0.0, 0.1]), None);
        assert_eq!(failure_of("collision", "depth", 1.0, [0.9, 1.0]), None);
        assert_eq!(failure_of("collision", "advance", 0.3, [0.0, 1.0]), None);
        assert!(failure_of("free", "distance", 0.1, [0.0, 0.1]).is_some());
        assert!(failure_of("collision", "depth", 0.9, [0.9, 1.0]).is_some());
    }

    #[test]
    fn a_probability_outside_of_its_bounds_is_wrong_whatever_the_label() {
        assert!(failure_of("contact", "distance", 0.5, [0.6, 0.7]).is_some());
    }
}
