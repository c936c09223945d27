//! What an answer costs: shown when asked for, limited, paid ahead; and the same answer for it.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::{Inputs, case_at, case_file};

#[test]
fn what_an_answer_cost_is_shown_when_asked_for() {
    let inputs = Inputs::new();
    let plain = inputs.query_at(0.1, &[]).quiet(0).stdout();
    for label in ["work  ", "time  "] {
        assert!(!plain.contains(label), "{plain}");
        let shown = inputs.query_at(0.1, &["-v"]);
        assert!(shown.code() == 0 && shown.stdout().contains(label), "{}", shown.stdout());
    }
    for label in ["collision probability", "verdict ", "clearance ", "contacts ", "where "] {
        assert!(plain.contains(label), "{plain}");
    }
}

#[test]
fn surfaces_ahead_do_not_change_an_answer() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &case_file(&[0.5, 0.1, 0.05].map(|z| case_at(&z.to_string(), z))));
    let probabilities = |refine: &str| {
        let lines = inputs.run(&["batch", "cases.json", "--json", "--refine", refine]).quiet(0);
        let of = |line: &serde_json::Value| line["collision_probability"].as_f64().unwrap();
        lines.json_lines().iter().map(of).collect::<Vec<f64>>()
    };
    let (ahead, lazily) = (probabilities("yes"), probabilities("no"));
    for (a, b) in ahead.iter().zip(&lazily) {
        // Beyond .999 a search ends at what it meets first.
        assert!((a - b).abs() < 1e-9 || a.min(*b) > 0.999, "{ahead:?} {lazily:?}");
    }
    assert_eq!(probabilities("auto").len(), 3);
}

/// Two noisy sheets take longer than a millisecond: nothing that was not looked at is free.
#[test]
fn a_deadline_ends_a_query_and_leaves_it_open() {
    let inputs = Inputs::new();
    let points = |height: f64| -> String {
        let at = |i: i32| (0.004 * f64::from(i % 200), 0.004 * f64::from(i / 200));
        (0..40_000).map(at).map(|(x, y)| format!("{x} {y} {height}\n")).collect()
    };
    inputs.write("low.xyz", &points(0.0));
    inputs.write("high.xyz", &points(0.03));
    let ask = |more: &[&str]| {
        let sheets = ["query", "low.xyz", "high.xyz", "--sensor", "iso:0.005", "--json"];
        inputs.run(&[&sheets[..], more].concat()).quiet(0).json_lines().remove(0)
    };
    let cut = ask(&["--deadline", "1"]);
    assert_eq!((&cut["bounds"][1], &cut["verdict"]), (&1.0.into(), &"undecided".into()), "{cut}");
    assert_eq!(cut["undecided_by"], "bounds", "{cut}");
    assert_eq!(ask(&[])["verdict"], "free");
}
