//! `--gradient` and `--penetration`: where to move an object, and how far.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::Inputs;
use serde_json::Value;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn a_gradient_is_answered_in_json_and_in_words() {
    let inputs = Inputs::new();
    let line = inputs.query_at(0.1, &["--gradient", "--json"]).quiet(0).json_lines().remove(0);
    let gradient = &line["gradient"];
    assert_eq!(
        (numbers(&gradient["probability"]).len(), numbers(&gradient["log_odds"]).len()),
        (6, 6)
    );
    assert_eq!(gradient["clearance_m"].is_null(), line["clearance_m"].is_null(), "{line}");
    let words = inputs.query_at(0.1, &["--gradient"]).quiet(0).stdout();
    assert!(words.contains("gradient of P") && words.contains("per rad"), "{words}");
    // Nothing more than was asked for, and nothing else changed by it.
    let mut plain = inputs.query_at(0.1, &["--json"]).quiet(0).json_lines().remove(0);
    assert!(plain.get("gradient").is_none(), "{plain}");
    plain["gradient"] = gradient.clone();
    plain["stats"] = line["stats"].clone();
    for body in ["scene", "object"] {
        plain[body] = line[body].clone();
    }
    assert_eq!(line, plain);
}

#[test]
fn a_way_out_is_answered_in_json_and_in_words_and_frees_the_object() {
    let inputs = Inputs::new();
    let deep = inputs.query_at(0.1, &["--json"]).quiet(0).json_lines().remove(0);
    assert!(deep["collision_probability"].as_f64().unwrap() > 0.1, "{deep}");
    let line = inputs.query_at(0.1, &["--penetration", "--json"]).quiet(0).json_lines().remove(0);
    let out = &line["penetration"];
    let direction = numbers(&out["direction"]);
    let distance = out["distance_m"].as_f64().unwrap();
    assert!(distance > 0.0 && out["std_m"].as_f64().unwrap() >= 0.0, "{line}");
    let norm = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    assert!((norm - 1.0).abs() < 1e-9, "{line}");
    let there: Vec<String> = direction
        .iter()
        .zip([0.01, 0.02, 0.1])
        .map(|(d, from)| (from + d * distance).to_string())
        .collect();
    let moved = format!("--translate={}", there.join(","));
    let files = ["query", "floor.pcd", "box.obj", "--sensor=iso:0.002", "--json"];
    let freed =
        inputs.run(&[&files, &[moved.as_str()][..]].concat()).quiet(0).json_lines().remove(0);
    assert!(freed["collision_probability"].as_f64().unwrap() < 0.1, "{freed}");
    let words = inputs.query_at(0.1, &["--penetration=0.2"]).quiet(0).stdout();
    assert!(words.contains("way out to P < 0.2") && words.contains(" mm along"), "{words}");
    let free = inputs.query_at(5.0, &["--penetration"]).quiet(0).stdout();
    assert!(free.contains("no move needed"), "{free}");
}

#[test]
fn what_is_no_probability_and_the_papers_mode_are_refused() {
    let inputs = Inputs::new();
    for (probability, words) in [("0", "above 0"), ("NaN", "finite"), ("deep", "number")] {
        let refused = inputs.query_at(0.1, &[&format!("--penetration={probability}")]);
        assert!(refused.code() == 2 && refused.stderr().contains(words), "{}", refused.stderr());
    }
    for option in ["--gradient", "--penetration"] {
        let paper = inputs.query_at(0.1, &[option, "--mode", "paper"]);
        assert!(paper.code() == 2 && paper.stderr().contains(option), "{}", paper.stderr());
    }
}
