//! `--margin` and `--pose-std`: how near two bodies are, and what an uncertain pose makes of it.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::{Inputs, case_at, case_file};

#[test]
fn a_margin_is_answered_in_json_and_in_words() {
    let inputs = Inputs::new();
    let line = inputs.query_at(0.1, &["--margin", "0.2", "--json"]).quiet(0).json_lines().remove(0);
    assert_eq!(line["margin"]["margin_m"], 0.2, "{line}");
    let probability = line["margin"]["probability"].as_f64().unwrap();
    let bounds: Vec<f64> =
        line["margin"]["bounds"].as_array().unwrap().iter().map(|b| b.as_f64().unwrap()).collect();
    assert!(bounds[0] <= probability && probability <= bounds[1], "{line}");
    assert!(probability >= line["collision_probability"].as_f64().unwrap(), "{line}");
    let of = |key: &str| line["clearance_m"][key].as_f64().unwrap();
    assert!(of("q05") <= of("q95") && line["clearance_m"].get("at_least").is_some(), "{line}");
    let words = inputs.query_at(0.1, &["--margin", "0.2"]).quiet(0).stdout();
    assert!(words.contains("P(nearer than 200 mm)"), "{words}");
    for (margin, told) in [("30", "P(nearer than 30 m)"), ("0.0005", "P(nearer than 0.5 mm)")] {
        let words = inputs.query_at(0.1, &["--margin", margin]).quiet(0).stdout();
        assert!(words.contains(told), "{words}");
    }
    // Nothing more than was asked for.
    let plain = inputs.query_at(0.1, &["--json"]).quiet(0).json_lines().remove(0);
    assert!(plain.get("margin").is_none() && plain["clearance_m"].get("q05").is_none(), "{plain}");
    let keys = |line: &serde_json::Value| -> Vec<String> {
        line.as_object().unwrap().keys().filter(|key| *key != "margin").cloned().collect()
    };
    assert_eq!(keys(&line), keys(&plain));
}

#[test]
fn a_margin_of_nothing_is_the_collision_and_a_batch_answers_too() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &case_file(&[0.5, 0.1].map(|z| case_at(&z.to_string(), z))));
    let lines =
        inputs.run(&["batch", "cases.json", "--json", "--margin", "0"]).quiet(0).json_lines();
    assert_eq!(lines.len(), 2);
    for line in lines {
        assert_eq!(line["margin"]["probability"], line["collision_probability"], "{line}");
        assert_eq!(line["margin"]["bounds"], line["bounds"], "{line}");
    }
}

/// Without --json a batch answered nothing of it.
#[test]
fn a_margin_was_not_in_the_table_of_a_batch() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &case_file(&[0.5, 0.15].map(|z| case_at(&z.to_string(), z))));
    let asked = ["batch", "cases.json", "--margin=0.2"];
    let lines = inputs.run(&[&asked[..], &["--json"]].concat()).quiet(0).json_lines();
    assert!(lines[1]["margin"]["probability"].as_f64().unwrap() > 0.9, "{}", lines[1]);
    let table = inputs.run(&asked).quiet(0).stdout();
    let rows: Vec<&str> = table.lines().collect();
    let end = rows[0].find("P(<200 mm)").unwrap() + "P(<200 mm)".len();
    for (row, line) in rows[1..].iter().zip(&lines) {
        let told: String = row.chars().take(end).collect();
        let told = told.rsplit(' ').next().unwrap().parse::<f64>().unwrap();
        let meant = line["margin"]["probability"].as_f64().unwrap();
        assert!((told - meant).abs() < 1e-3, "{meant}: {table}");
    }
    // What was measured of nothing is an object all the same.
    assert!(lines[0]["clearance_m"]["mean"].is_null() && lines[0]["clearance_m"]["std"].is_null());
    assert!(lines[0]["clearance_m"].is_object(), "{}", lines[0]);
    assert!(!inputs.run(&asked[..2]).quiet(0).stdout().contains("P(<"));
}

#[test]
fn an_uncertain_pose_is_answered_over_all_that_it_may_be() {
    let inputs = Inputs::new();
    let ask = |more: &[&str]| inputs.query_at(0.1, more).quiet(0);
    let line = ask(&["--pose-std", "0.05,0.05,0.05,0.1,0.1,0.1", "--json"]).json_lines().remove(0);
    let under = &line["pose_uncertainty"];
    let bounds = under["bounds"].as_array().unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let probability = number(&under["probability"]);
    assert!(number(&bounds[0]) <= probability && probability <= number(&bounds[1]), "{line}");
    assert!(under["poses"].as_u64().unwrap() > 1 && number(&under["std_error"]) >= 0.0, "{line}");
    // A pose that is known is the plain answer.
    let known = ask(&["--pose-std", "0,0,0,0,0,0", "--json"]).json_lines().remove(0);
    assert_eq!(known["pose_uncertainty"]["probability"], known["collision_probability"], "{known}");
    let words = ask(&["--pose-std", "0.05,0,0,0,0,0"]).stdout();
    assert!(words.contains("over uncertain poses"), "{words}");
    for (stds, why) in
        [("0.1,0.1", "six"), ("-0.1,0,0,0,0,0", "negative"), ("0,0,0,90,0,0", "degrees")]
    {
        let refused = inputs.query_at(0.1, &[&format!("--pose-std={stds}")]);
        assert!(refused.code() == 2 && refused.stderr().contains(why), "{}", refused.stderr());
    }
}

#[test]
fn a_margin_that_no_bodies_can_keep_is_refused() {
    let inputs = Inputs::new();
    for (margin, words) in [("-0.01", "0 or more"), ("NaN", "finite"), ("wide", "number")] {
        let refused = inputs.query_at(0.1, &[&format!("--margin={margin}")]);
        assert!(refused.code() == 2 && refused.stderr().contains(words), "{}", refused.stderr());
    }
    let paper = inputs.query_at(0.1, &["--margin", "0.01", "--mode", "paper"]);
    assert!(paper.code() == 2 && paper.stderr().contains("--margin"), "{}", paper.stderr());
}
