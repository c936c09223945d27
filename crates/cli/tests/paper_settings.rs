//! The paper's mode from the command line: all its settings in a file, and what it says of each point.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::{Inputs, Run};
use serde_json::Value;

const PAPER: [&str; 3] = ["--json", "--mode", "paper"];

/// With the box a millimetre above the floor.
fn ask(inputs: &Inputs, more: &[&str]) -> Value {
    inputs.query_at(0.101, &[&PAPER[..], more].concat()).quiet(0).json_lines()[0].clone()
}

/// With more settings of a query, amended so far that the answer is in doubt.
fn ask_with(inputs: &Inputs, settings: &str, more: &[&str]) -> Value {
    let amended = "[query]\nshared_points = false\nmesh_points = \"as_dense_as_cloud\"\n";
    let kernel = "kernel = { gaussian = { gamma = 1000.0 } }\n";
    let kernel = if settings.contains("kernel") { "" } else { kernel };
    let settings = format!("{amended}{kernel}{settings}");
    inputs.write("one.toml", &settings);
    ask(inputs, &[&["--settings", "one.toml"], more].concat())
}

/// What was said of a wrong use.
fn refusal(run: &Run, code: i32) -> String {
    assert_eq!(run.code(), code, "{}", run.stderr());
    run.stderr()
}

/// A number somewhere in a report.
fn number(report: &Value, pointer: &str) -> f64 {
    report.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("{pointer}: {report}"))
}

#[test]
fn the_printed_settings_are_read_back_and_change_nothing() {
    let inputs = Inputs::new();
    let text = inputs.run(&["settings"]).quiet(0).stdout();
    assert!(text.contains("max_variation") && text.contains("kappa"), "{text}");
    inputs.write("all.toml", &text);
    let answers = [ask(&inputs, &[]), ask(&inputs, &["--settings", "all.toml"])];
    let [usual, from_file] = answers.map(|mut answer| {
        answer.as_object_mut().unwrap().remove("stats");
        answer
    });
    assert_eq!(usual, from_file);
}

#[test]
fn a_parameter_study_needs_no_rust() {
    let inputs = Inputs::new();
    let with = |text: &str| ask_with(&inputs, text, &[]);
    let usual = with("");
    let all = "stop_above = 1.0\ntraversal = \"certified\"\n";
    let pairs = |text: &str| number(&with(&format!("{all}{text}")), "/stats/leaf_pairs");
    assert!(pairs("[cloud.tree]\nmax_leaf_points = 10") > pairs(""));
    for change in
        ["kernel = \"linear\"", "kappa = 0.999", "kernel = { gaussian = { gamma = 300.0 } }"]
    {
        let changed = with(change);
        let probability = |report: &Value| number(report, "/collision_probability");
        assert!((probability(&changed) - probability(&usual)).abs() > 1e-3, "{change}: {changed}");
    }
    // An option of the command line comes first.
    inputs.write("one.toml", "[query]\nseed = 7\naccept = 0.8\n");
    let seed = |more: &[&str]| number(&ask(&inputs, more), "/seed");
    assert_eq!(seed(&["--settings", "one.toml"]), 7.0);
    assert_eq!(seed(&["--settings", "one.toml", "--seed", "9"]), 9.0);
}

#[test]
fn a_wrong_file_or_mode_is_refused() {
    let inputs = Inputs::new();
    inputs.write("bad.toml", "[query]\ngama = 3\n");
    let refused = |more: &[&str]| refusal(&inputs.query_at(0.2, more), 2);
    assert!(refused(&["--mode", "paper", "--settings", "bad.toml"]).contains("gama"));
    assert!(refused(&["--mode", "paper", "--settings", "none.toml"]).contains("none.toml"));
    inputs.write("many.toml", "[cloud.discretization]\nneighbors = 100000\n");
    let many = refused(&["--mode", "paper", "--settings", "many.toml"]);
    assert!(many.contains("discretization.neighbors` is 100000") && many.contains("200"), "{many}");
    inputs.write("good.toml", "");
    assert!(refused(&["--settings", "good.toml"]).contains("--mode paper"));
    assert!(refused(&["--json", "--explain"]).contains("--mode paper"));
}

#[test]
fn points_and_classifiers_are_told_on_request() {
    let inputs = Inputs::new();
    let plain = ask_with(&inputs, "", &[]);
    assert!(plain.get("points").is_none() && plain.get("classifiers").is_none());
    let told = ask_with(&inputs, "", &["--points", "--explain"]);
    let of_floor = told["points"]["a"].as_array().unwrap();
    let largest = of_floor.iter().map(|pair| pair[1].as_f64().unwrap()).fold(0.0, f64::max);
    assert!(!of_floor.is_empty() && largest <= number(&told, "/max_probability"));
    assert!(number(&told, "/noisy_or_probability") >= largest);
    let first = &told["classifiers"][0]["points"][0];
    for key in ["f", "xi", "alpha", "probability"] {
        assert!(first[key].is_number(), "{key}: {first}");
    }
    assert_eq!(first["v"].as_array().unwrap().len(), 3);
    // On the default path too, where no classifier is told.
    let by_default =
        inputs.query_at(0.101, &["--json", "--points"]).quiet(0).json_lines()[0].clone();
    assert!(by_default["points"]["a"].is_array(), "{by_default}");
}

#[test]
fn a_table_has_a_row_for_each_point() {
    let inputs = Inputs::new();
    let answer = ask_with(&inputs, "", &["--points", "--csv", "points.csv"]);
    let table = std::fs::read_to_string(inputs.path("points.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    // The box is a mesh: exact, without points of its own.
    assert_eq!(rows.len(), 1 + 441);
    assert_eq!(rows[0], "body,index,x,y,z,probability");
    let pair = &answer["points"]["a"][0];
    let row = rows[1 + pair[0].as_u64().unwrap() as usize];
    assert!(row.ends_with(&format!(",{}", pair[1].as_f64().unwrap())), "{row} {pair}");
}

#[test]
fn several_scans_make_one_scene() {
    let inputs = Inputs::new();
    let one = inputs.query_at(0.3, &["--json"]).quiet(0);
    assert_eq!(one.json_lines()[0]["verdict"], "free");
    // Another scan of the scene: a shelf where the box is put.
    let row =
        |i: i32| format!("{} {} 0.3", 0.05 * f64::from(i % 9 - 4), 0.05 * f64::from(i / 9 - 4));
    inputs.write("shelf.xyz", &(0..81).map(row).collect::<Vec<_>>().join("\n"));
    inputs.write("dense.toml", "[query]\nmesh_points = \"as_dense_as_cloud\"\n");
    for mode in [&["--mode", "calibrated"][..], &["--mode", "paper", "--settings", "dense.toml"]] {
        let both = inputs.query_at(0.3, &[&["--also", "shelf.xyz", "--json"], mode].concat());
        assert_eq!(both.quiet(0).json_lines()[0]["verdict"], "in_collision", "{mode:?}");
    }
    let text = inputs.query_at(0.3, &["--also", "shelf.xyz"]).quiet(0).stdout();
    assert!(text.contains("522 points"), "{text}");
}

#[test]
fn each_row_of_the_scene_may_have_its_kappa() {
    let inputs = Inputs::new();
    let usual = ask_with(&inputs, "", &[]);
    inputs.write("kappas.txt", &"0.999\n".repeat(441));
    let wide = ask_with(&inputs, "", &["--kappas", "kappas.txt"]);
    assert_ne!(wide["collision_probability"], usual["collision_probability"]);
    inputs.write("few.txt", "0.9\n");
    let refused = inputs.query_at(0.1, &[&PAPER[..], &["--kappas", "few.txt"]].concat());
    let refused = refusal(&refused, 1);
    assert!(refused.contains("a line for each row"), "{refused}");
}

/// Those of another scene were taken as far as they went, and a mesh was no wrong usage.
#[test]
fn kappas_of_another_scene_are_refused() {
    let inputs = Inputs::new();
    inputs.write("many.txt", &"0.9\n".repeat(442));
    let refused = inputs.query_at(0.1, &[&PAPER[..], &["--kappas", "many.txt"]].concat());
    let refused = refusal(&refused, 1);
    assert!(refused.contains("many.txt: 442 kappas, and the scene has 441 rows"), "{refused}");
    let of_a_mesh = ["query", "box.obj", "floor.pcd", "--mode=paper", "--kappas=many.txt"];
    let of_a_mesh = inputs.run(&of_a_mesh);
    assert!(refusal(&of_a_mesh, 2).contains("--kappas is for a scene that is a cloud"));
}
