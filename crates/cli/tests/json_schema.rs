//! The JSON report has exactly the documented keys, in the documented order.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::{HEIGHTS, Inputs, case_at, case_file};
use serde_json::Value;

/// As documented in the README.
const REPORT: [&str; 19] = [
    "id",
    "collision_probability",
    "bounds",
    "verdict",
    "undecided_by",
    "log_likelihood_ratio",
    "clearance_m",
    "clearance_at_least_m",
    "contacts",
    "evidence",
    "unseen",
    "warnings",
    "stats",
    "seed",
    "mode",
    "placement",
    "pose",
    "scene",
    "object",
];
const CLEARANCE: [&str; 3] = ["mean", "std", "is_bound"];
const CONTACT: [&str; 5] = ["point", "normal_a_to_b", "probability", "clearance_m", "area_m2"];
const EVIDENCE: [&str; 6] = [
    "deviations",
    "crossing",
    "extent",
    "misclassified",
    "noise_over_spacing",
    "scatter_over_spacing",
];
const PLACEMENT: [&str; 4] = ["scene_box", "object_box", "box_gap_m", "nearest_m"];
const INPUT: [&str; 4] = ["file", "unit", "sensor", "sensor_because"];
const UNSEEN: [&str; 7] = [
    "body",
    "behind_camera",
    "outside_view",
    "hole",
    "out_of_range",
    "behind_returns",
    "close_behind",
];
const WARNING: [&str; 3] = ["code", "values", "words"];
const STATS: [&str; 9] = [
    "nodes_visited",
    "leaf_pairs",
    "linear_certificates",
    "kernel_solves",
    "fallbacks",
    "undecided",
    "max_relative_gap",
    "prepare_us",
    "query_us",
];

#[test]
fn reports_have_the_documented_keys() {
    let inputs = Inputs::new();
    let mut contacts = 0;
    for (verdict, _, height) in HEIGHTS {
        let run = inputs.query_at(height, &["--json"]).quiet(0);
        assert_eq!(run.stdout().lines().count(), 1);
        let report = run.json_lines().remove(0);
        check_report(&report);
        contacts += report["contacts"].as_array().unwrap().len();
        assert_eq!((&report["id"], &report["seed"]), (&"query".into(), &0.into()));
        assert_eq!((&report["mode"], &report["verdict"]), (&"calibrated".into(), &verdict.into()));
    }
    assert!(contacts > 0, "no contact was checked");
    let paper = inputs
        .query_at(0.5, &["--json", "--mode", "paper", "--seed", "7"])
        .quiet(0)
        .json_lines()
        .remove(0);
    check_report(&paper);
    assert_eq!((&paper["mode"], &paper["seed"]), (&"paper".into(), &7.into()));
}

#[test]
fn keys_come_in_the_documented_order() {
    let inputs = Inputs::new();
    let text = inputs.query_at(0.1, &["--json"]).quiet(0).stdout();
    // The clearance of a contact has the name of that of the report: look past it.
    let order: Vec<&str> = REPORT[..7]
        .iter()
        .chain(&CLEARANCE)
        .chain(&["clearance_at_least_m", "contacts"])
        .chain(&CONTACT)
        .copied()
        .collect();
    let mut at = 0;
    for key in order
        .into_iter()
        .chain(["evidence"])
        .chain(EVIDENCE)
        .chain(["unseen", "warnings", "stats"])
        .chain(STATS)
        .chain(["seed", "mode", "placement"])
        .chain(PLACEMENT)
        .chain(["pose", "scene"])
        .chain(INPUT)
        .chain(["object"])
    {
        let quoted = format!("\"{key}\":");
        let found = text[at..].find(&quoted);
        at += found.unwrap_or_else(|| panic!("{key} is missing or too early in {text}"));
    }
}

#[test]
fn far_apart_the_clearance_is_null() {
    let inputs = Inputs::new();
    let scene = ["query", "floor.pcd", "floor.pcd", "--translate=0,0,15", "--json"];
    let report = inputs.run(&scene).quiet(0).json_lines().remove(0);
    check_report(&report);
    assert_eq!((&report["clearance_m"], &report["verdict"]), (&Value::Null, &"free".into()));
}

#[test]
fn two_clouds_in_the_calibrated_mode_have_evidence() {
    let inputs = Inputs::new();
    let clouds = |mode| {
        let scene = ["query", "floor.pcd", "floor.pcd", "--json", "--mode", mode];
        inputs.run(&scene).quiet(0).json_lines().remove(0)
    };
    let calibrated = clouds("calibrated");
    check_report(&calibrated);
    assert!(calibrated["evidence"]["crossing"].is_f64(), "{calibrated}");
    assert!(clouds("paper")["evidence"].is_null());
}

#[test]
fn lines_of_a_batch_are_reports_or_errors() {
    let inputs = Inputs::new();
    let cases = [case_at("good", 0.1), r#"{"id":"bad"}"#.to_owned()];
    inputs.write("cases.json", &case_file(&cases));
    let lines = inputs.run(&["batch", "cases.json", "--json"]).quiet(1).json_lines();
    check_report(&lines[0]);
    check_keys(&lines[1], &["id", "error"]);
    assert_eq!((&lines[0]["id"], &lines[1]["id"]), (&"good".into(), &"bad".into()));
}

fn check_report(report: &Value) {
    check_keys(report, &REPORT);
    let number = |v: &Value| v.as_f64().unwrap();
    let probability = number(&report["collision_probability"]);
    let bounds = numbers(&report["bounds"], 2);
    assert!(0.0 <= bounds[0] && bounds[0] <= probability, "{report}");
    assert!(probability <= bounds[1] && bounds[1] <= 1.0, "{report}");
    let verdicts = ["free", "uncertain", "in_collision", "undecided"];
    assert!(verdicts.contains(&report["verdict"].as_str().unwrap()));
    if !report["clearance_m"].is_null() {
        check_keys(&report["clearance_m"], &CLEARANCE);
        assert!(number(&report["clearance_m"]["std"]) >= 0.0);
    }
    for contact in report["contacts"].as_array().unwrap() {
        check_keys(contact, &CONTACT);
        numbers(&contact["point"], 3);
        let length: f64 = numbers(&contact["normal_a_to_b"], 3).iter().map(|v| v * v).sum();
        assert!((length - 1.0).abs() < 1e-9, "{contact}");
        assert!((0.0..=1.0).contains(&number(&contact["probability"])));
        number(&contact["clearance_m"]);
    }
    // Only the calibrated mode has it; see below.
    if !report["evidence"].is_null() {
        check_keys(&report["evidence"], &EVIDENCE);
    }
    check_keys(&report["stats"], &STATS);
    check_keys(&report["placement"], &PLACEMENT);
    for body in ["scene", "object"] {
        check_keys(&report[body], &INPUT);
    }
    if !report["unseen"].is_null() {
        check_keys(&report["unseen"], &UNSEEN);
    }
    for warning in report["warnings"].as_array().unwrap() {
        check_keys(warning, &WARNING);
    }
    let rows = report["pose"].as_array().unwrap();
    assert!(rows.len() == 4 && rows.iter().all(|row| numbers(row, 4)[3].is_finite()), "{report}");
    for (key, value) in report["stats"].as_object().unwrap() {
        assert!(value.is_u64() || key == "max_relative_gap" && value.is_f64(), "{key}: {value}");
    }
    assert!(report["seed"].is_u64());
    assert!(["calibrated", "paper"].contains(&report["mode"].as_str().unwrap()));
}

fn check_keys(value: &Value, expected: &[&str]) {
    let mut found: Vec<&str> = value.as_object().unwrap().keys().map(String::as_str).collect();
    let mut expected = expected.to_vec();
    found.sort_unstable();
    expected.sort_unstable();
    assert_eq!(found, expected);
}

fn numbers(value: &Value, count: usize) -> Vec<f64> {
    let numbers: Vec<f64> = value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    assert_eq!(numbers.len(), count, "{value}");
    numbers
}
