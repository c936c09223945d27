//! Forty labelled poses in real scans: clear cases must be answered clearly.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Mesh, Query, QueryError, QuerySettings, Report};
use cloudtouch_io::{Geometry, LengthUnit, read_geometry};

use super::cases::{self, Labelled};
use crate::report::table::probability;
use crate::report::{Findings, Section, Table, Target};

/// The sensor of each scan, by a part of its file name.
const SENSORS: [(&str, &str); 5] = [
    ("mug", "iso:0.005"),
    ("mosd", "kinect"),
    ("template", "kinect"),
    ("samp11", "axes:0.3,0.3,0.15"),
    ("room_scan", "lidar:0.02,0.003"),
];
/// A free case must stay below, a deep one above.
const FREE_BELOW: f64 = 0.1;
const COLLISION_ABOVE: f64 = 0.9;

type Answer = Result<Report, QueryError>;

pub(super) fn evaluate(data: &Path) -> Findings {
    let cases = cases::read(&data.join("cases.json"))?;
    let mut bodies: BTreeMap<&PathBuf, Body> = BTreeMap::new();
    for path in cases.iter().flat_map(|case| [&case.scene, &case.object]) {
        if !bodies.contains_key(path) {
            bodies.insert(path, body(path)?);
        }
    }
    let query = Query::new(QuerySettings::default())?;
    let ask = |case: &Labelled| query.run(&bodies[&case.scene], &bodies[&case.object], &case.pose);
    let answers: Vec<Answer> = cases.iter().map(ask).collect();
    let both = || cases.iter().zip(&answers);
    let failures: Vec<String> = both().filter_map(|(case, answer)| failure(case, answer)).collect();
    let checked = cases.iter().filter(|case| wanted(case).is_some()).count();
    let sensors = SENSORS.map(|(part, spec)| format!("{part} {spec}")).join(", ");
    let text = format!(
        "{} cases, default settings, sensors by file: {sensors}. Checked: every case has an answer \
         within its bounds, every `free` case has P < {FREE_BELOW}, every `collision` case that is \
         deep (basis `depth`) has P > {COLLISION_ABOVE} ({checked} cases). The other labels are \
         not checked: they describe the measured points, not the surface behind them. The smallest \
         distance is that of the single worst raw point. Times are those of one thread; the first \
         query at a place of a scan also pays for its noise model there.",
        cases.len(),
    );
    let section =
        Section::new("Labelled poses in real scans").text(text).text(each(&cases, &answers));
    let found = if failures.is_empty() { "none".into() } else { failures.join("; ") };
    let target =
        Target::new("labelled poses: no unclear or unsound answers", found, failures.is_empty());
    Ok((section, vec![target]))
}

fn body(path: &Path) -> Result<Body> {
    let name = file_name(path);
    Ok(match read_geometry(path, LengthUnit::Metres)? {
        Geometry::Mesh(mesh) => Body::from(Mesh::prepare(&mesh)?),
        Geometry::Cloud(cloud) => {
            let found = SENSORS.iter().find(|(part, _)| name.contains(part));
            let (_, spec) = found.with_context(|| format!("{name}: no sensor is known"))?;
            let sensor: SensorModel = spec.parse()?;
            Body::Cloud(Cloud::prepare(&cloud, &CloudSettings::new(sensor))?)
        }
    })
}

/// The probabilities between which the answer to a clear case must lie.
fn wanted(case: &Labelled) -> Option<[f64; 2]> {
    match (case.label.as_str(), case.basis.as_str()) {
        ("free", _) => Some([f64::NEG_INFINITY, FREE_BELOW]),
        ("collision", "depth") => Some([COLLISION_ABOVE, f64::INFINITY]),
        _ => None,
    }
}

/// What is wrong with the answer: of any case that it is missing or contradicts its bounds, of a
/// clear one also that it is not clear.
fn failure(case: &Labelled, answer: &Answer) -> Option<String> {
    let wrong = match answer {
        Ok(report) => wrong(report.collision_probability, report.bounds, wanted(case)),
        Err(error) => Some(format!("no answer: {error}")),
    };
    wrong.map(|wrong| format!("{}: {wrong}", case.id))
}

fn wrong(p: f64, [low, high]: [f64; 2], wanted: Option<[f64; 2]>) -> Option<String> {
    if !(low <= p && p <= high) {
        return Some(format!("P {p} is not within its bounds {low} .. {high}"));
    }
    let [least, most] = wanted?;
    // Strictly inside; NaN is not.
    (!(least < p && p < most)).then(|| format!("P {p} of a clear case"))
}

fn each(cases: &[Labelled], answers: &[Answer]) -> Table {
    const HEADER: &str = "case, label (basis), scene / object, smallest distance (mm), P, bounds, \
                          verdict, clearance (mm), query (ms)";
    let mut table = Table::new(HEADER.split(", "));
    for (case, answer) in cases.iter().zip(answers) {
        let mut cells = vec![
            case.id.clone(),
            format!("{} ({})", case.label, case.basis),
            format!("{} / {}", file_name(&case.scene), file_name(&case.object)),
            format!("{:+.1}", case.distance_mm),
        ];
        cells.extend(match answer {
            Err(_) => ["no answer", "-", "-", "-", "-"].map(String::from),
            Ok(report) => [
                probability(report.collision_probability),
                report.bounds.map(probability).join(" .. "),
                report.verdict.to_string(),
                report.clearance_m.map_or("-".to_owned(), |c| {
                    format!("{:+.1} ± {:.1}", 1e3 * c.mean, 1e3 * c.std)
                }),
                format!("{:.1}", 1e-3 * report.stats.query_us as f64),
            ],
        });
        table.row(cells);
    }
    table
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clear_cases_need_clear_answers_and_all_need_sound_ones() {
        let fails = |p, bounds, wanted| wrong(p, bounds, wanted).is_some();
        let clear = Some([0.9, f64::INFINITY]);
        assert!(!fails(1.0, [0.9, 1.0], clear) && !fails(0.3, [0.0, 1.0], None));
        assert!(fails(0.9, [0.9, 1.0], clear) && fails(f64::NAN, [0.0, 1.0], clear));
        assert!(fails(0.5, [0.6, 0.7], None) && fails(f64::NAN, [0.0, 1.0], None));
    }
}
