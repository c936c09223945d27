//! `cloudtouch path`: a box moved over the floor and through it.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::{Inputs, Run};

/// Heights of the box along a path, at a place away from the rows of the floor.
fn csv(heights: &[f64]) -> String {
    let line = |z: &f64| format!("0.01,0.02,{z},1,0,0,0\n");
    std::iter::once("x,y,z,qw,qx,qy,qz\n".to_owned()).chain(heights.iter().map(line)).collect()
}

fn json(heights: &[f64]) -> String {
    let pose = |z: &f64| format!("[[1,0,0,0.01],[0,1,0,0.02],[0,0,1,{z}],[0,0,0,1]]");
    format!("[{}]", heights.iter().map(pose).collect::<Vec<_>>().join(","))
}

fn path(inputs: &Inputs, poses: &str, more: &[&str]) -> Run {
    let arguments = ["path", "floor.pcd", "box.obj", "--sensor=iso:0.002", "--poses", poses];
    inputs.run(&[&arguments, more].concat())
}

#[test]
fn a_box_through_the_floor_is_found_between_two_free_poses() {
    let inputs = Inputs::new();
    let heights = [0.6, 0.5, -0.5];
    inputs.write("through.csv", &csv(&heights));
    inputs.write("through.json", &json(&heights));
    let run = path(&inputs, "through.csv", &["--json", "--exit-code"]).quiet(20);
    let found = run.json_lines().remove(0);
    let first = &found["first"];
    assert_eq!((&first["segment"], &found["verdict"]), (&1.into(), &"in_collision".into()));
    // Its lower side is at the floor after 40 of 100 cm, its upper side after 60.
    let t = first["t"].as_f64().unwrap();
    assert!((0.39..0.5).contains(&t), "{t}");
    let height = first["pose"][2][3].as_f64().unwrap();
    assert!((height - (0.5 - t)).abs() < 1e-9, "{height}");
    assert!(found["max_probability"].as_f64().unwrap() > 0.9);
    assert_eq!(found["bounds"][1], 1.0);
    let free = found["certified_free_until"].as_f64().unwrap();
    assert!((0.6..0.71).contains(&free), "{free}");
    assert!(first["not_before"].as_f64().unwrap() <= first["share"].as_f64().unwrap());
    assert!(found["stats"]["poses"].as_u64().unwrap() > 2);
    // The same from the other format, but for the time.
    let other = path(&inputs, "through.json", &["--json"]).quiet(0).json_lines().remove(0);
    assert_eq!((&other["first"], &other["bounds"]), (first, &found["bounds"]));
    let text = path(&inputs, "through.json", &[]).quiet(0).stdout();
    assert!(text.contains("in collision from      segment 2, t = 0.4"), "{text}");
}

#[test]
fn a_path_above_the_floor_is_free_and_says_so() {
    let inputs = Inputs::new();
    inputs.write("above.csv", &csv(&[0.6, 0.4]));
    let run = path(&inputs, "above.csv", &["--json", "--exit-code"]).quiet(0);
    let found = run.json_lines().remove(0);
    assert_eq!((&found["first"], &found["verdict"]), (&serde_json::Value::Null, &"free".into()));
    assert_eq!(found["certified_free_until"], 1.0);
    assert!(found["bounds"][1].as_f64().unwrap() < 0.1);
    let text = path(&inputs, "above.csv", &[]).quiet(0).stdout();
    assert!(text.contains("free for certain       until 100.0 % of the path"), "{text}");
}

/// Half a turn about an axis half a metre up leads down through the floor; the straight way does not.
#[test]
fn a_screw_leads_where_a_straight_way_does_not() {
    let inputs = Inputs::new();
    let turn = (-85.0_f64).to_radians();
    let end = format!("0.5,0.02,0.5,{},0,{},0\n", turn.cos(), turn.sin());
    inputs.write("turn.csv", &format!("x,y,z,qw,qx,qy,qz\n-0.5,0.02,0.5,1,0,0,0\n{end}"));
    let straight = path(&inputs, "turn.csv", &["--json"]).quiet(0).json_lines().remove(0);
    assert_eq!(straight["verdict"], "free");
    let screw = path(&inputs, "turn.csv", &["--json", "--screw"]).quiet(0).json_lines().remove(0);
    assert_eq!(screw["verdict"], "in_collision");
    let height = screw["first"]["pose"][2][3].as_f64().unwrap();
    assert!(height < 0.2, "{height}");
}

#[test]
fn a_path_in_millimetres_is_undecided_and_says_why() {
    let inputs = Inputs::new();
    inputs.write("far.csv", &csv(&[600.0, 400.0]));
    let run = path(&inputs, "far.csv", &["--json", "--exit-code"]).quiet(30);
    let found = run.json_lines().remove(0);
    assert_eq!((&found["verdict"], &found["undecided_by"]), (&"undecided".into(), &"units".into()));
    let warnings = found["warnings"].as_array().unwrap();
    assert_eq!(warnings.len(), 1, "once for the whole path: {warnings:?}");
    assert_eq!(warnings[0]["code"], "far_away");
    assert!(warnings[0]["words"].as_str().unwrap().contains("check the pose"));
    assert!(warnings[0]["values"]["gap_m"].as_f64().unwrap() > 590.0, "as it begins");
    let text = path(&inputs, "far.csv", &[]).quiet(0).stdout();
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("verdict undecided: sizes or distance are implausible"), "{text}");
    assert!(words.contains("warning the object is"), "{text}");
}

/// In the order of ROS no turn at all, or none about x, it was half a turn without a word.
#[test]
fn poses_of_ros_without_a_header_were_half_turns_in_silence() {
    let inputs = Inputs::new();
    inputs.write("ros.csv", "# from a bag\n0.01,0.02,0.6,0,0,0,1\n0.01,0.02,0.4,0,0,0,-1\n");
    let run = path(&inputs, "ros.csv", &["--json"]);
    assert_eq!((run.code(), run.json_lines().len()), (0, 1), "{}", run.stderr());
    let warning = run.stderr();
    for part in [
        "ros.csv: line 2: `0.01,0.02,0.6,0,0,0,1`",
        "half a turn",
        "x,y,z,qw,qx,qy,qz",
        "x,y,z,qx,qy,qz,qw",
    ] {
        assert!(warning.contains(part), "`{part}` is not in {warning}");
    }
    assert_eq!(warning.lines().count(), 1, "{warning}");
    let of_json = |run: &Run| {
        let answer = run.json_lines().remove(0);
        let warnings = answer["warnings"].as_array().unwrap().clone();
        warnings.into_iter().find(|warning| warning["code"] == "quaternion_order")
    };
    let in_json = of_json(&run).unwrap();
    assert_eq!(in_json["values"]["line"], 2, "{in_json}");
    assert!(warning.contains(in_json["words"].as_str().unwrap()), "{in_json}");
    // Turned about z by ROS, and about y by half a turn.
    for (name, text) in [
        ("yaw.csv", "0.01,0.02,0.6,0,0,0.6,0.8\n0.01,0.02,0.4,1e-7,0,0.8,0.6\n"),
        ("about_x.csv", "0.01,0.02,0.6,0,1,0,0\n0.01,0.02,0.4,0,1,0,0\n"),
        // With a milliradian of roll and two degrees of pitch.
        ("tilted.csv", "0.01,0.02,0.6,5e-4,0.0174,0.6,0.7998\n0.01,0.02,0.4,5e-4,0,0,1\n"),
    ] {
        inputs.write(name, text);
        let run = path(&inputs, name, &["--json"]);
        assert!(of_json(&run).is_some() && run.stderr().contains(name), "{}", run.stderr());
    }
    // Said by a header they are meant.
    for (name, text) in [
        ("said.csv", "x,y,z,qw,qx,qy,qz\n0.01,0.02,0.6,0,0,0,1\n0.01,0.02,0.4,0,0,0,1\n"),
        ("ros_said.csv", "x,y,z,qx,qy,qz,qw\n0.01,0.02,0.6,0,0,0,1\n0.01,0.02,0.4,0,0,0,1\n"),
        ("commented.csv", "# x,y,z,qx,qy,qz,qw\n0.01,0.02,0.6,0,0,0,1\n0.01,0.02,0.4,0,0,0,1\n"),
        (
            "tum.csv",
            "# time tx ty tz qx qy qz qw\n1 0.01 0.02 0.6 0 0 0 1\n2 0.01 0.02 0.4 0 0 0 1\n",
        ),
        ("about_x.csv", "x,y,z,qw,qx,qy,qz\n0,0.02,0.6,0,1,0,0\n0,0.02,0.4,0,1,0,0\n"),
    ] {
        inputs.write(name, text);
        path(&inputs, name, &[]).quiet(0);
    }
}

/// Only half turns were told; any other order of the columns was taken for the usual one in silence.
#[test]
fn an_answer_about_columns_without_names_says_how_they_were_read() {
    let inputs = Inputs::new();
    inputs.write("turned.csv", "# a hand\n0.01,0.02,0.6,0,0,0,1\n0.01,0.02,0.4,1,0,0,0\n");
    let run = path(&inputs, "turned.csv", &["--json"]);
    let answer = run.json_lines().remove(0);
    let warnings = answer["warnings"].as_array().unwrap();
    let of_file = warnings.iter().find(|warning| warning["code"] == "unnamed_columns").unwrap();
    assert_eq!(of_file["values"], serde_json::json!({ "line": 2, "row": "0.01,0.02,0.6,0,0,0,1" }));
    let words = of_file["words"].as_str().unwrap();
    for part in ["line 2: ", "is read as x,y,z,qw,qx,qy,qz", "begin", "with x,y,z,qx,qy,qz,qw"] {
        assert!(words.contains(part), "{words}");
    }
    assert!(run.stderr().contains(&format!("turned.csv: {words}")), "{}", run.stderr());
    let text = path(&inputs, "turned.csv", &[]).stdout();
    let told = "\ncolumns                read as x,y,z,qw,qx,qy,qz, for the file names none\n";
    assert!(text.contains(told), "{text}");
}

#[test]
fn bad_paths_are_named_with_what_to_do() {
    let inputs = Inputs::new();
    for (name, text, part) in [
        ("one.csv", csv(&[0.5]), "a path through one pose: give at least two"),
        ("still.json", json(&[0.5, 0.5]), "all 2 poses of the path are the same"),
        ("short.csv", "0,0,0,1\n".to_owned(), "write 7 numbers"),
    ] {
        inputs.write(name, &text);
        let run = path(&inputs, name, &[]);
        assert_eq!(run.code(), 1);
        let error = run.stderr();
        assert!(error.contains(name) && error.contains(part), "{error}");
    }
    inputs.write("good.csv", &csv(&[0.5, 0.4]));
    for tolerance in ["0", "2"] {
        let run = path(&inputs, "good.csv", &["--tolerance", tolerance]);
        assert!(run.code() == 2 && run.stderr().contains("--tolerance"), "{}", run.stderr());
        assert!(run.stderr().contains(&format!("'{tolerance}'")), "{}", run.stderr());
    }
    let run = path(&inputs, "good.csv", &["--mode", "paper"]);
    assert!(run.code() == 2 && run.stderr().contains("calibrated mode"), "{}", run.stderr());
    let run = path(&inputs, "good.csv", &["--margin", "0.1"]);
    assert!(run.code() == 2 && run.stderr().contains("--margin"), "{}", run.stderr());
    assert!(path(&inputs, "gone.csv", &[]).stderr().contains("cannot read the path"));
}

/// Which way round was decided by the last digit, without a word.
#[test]
fn half_a_turn_between_two_poses_is_warned_of() {
    let inputs = Inputs::new();
    let told = |second: &str| {
        inputs
            .write("turn.csv", &format!("x,y,z,qw,qx,qy,qz\n0,0,0.5,1,0,0,0\n0,0,0.5,{second}\n"));
        let text = path(&inputs, "turn.csv", &[]).stdout();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    assert!(told("0,0,0,1").contains("from pose 1 to the next it turns by half a turn"));
    assert!(told("-0.0001,0,0,1").contains("give a pose between them"));
    assert!(!told("0.1,0,0,0.99498744").contains("half a turn"));
    assert_eq!(path(&inputs, "turn.csv", &[]).stderr(), "");
}
