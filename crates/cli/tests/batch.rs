//! `cloudtouch batch`: tables, JSON lines, bad cases among good ones.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::pages::page;
use crate::support::{HEIGHTS, Inputs, case_at, case_file};

fn good_cases() -> String {
    case_file(&HEIGHTS.map(|(verdict, _, height)| case_at(verdict, height)))
}

#[test]
fn every_case_gets_a_line_in_order() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &good_cases());
    let lines = inputs.run(&["batch", "cases.json", "--json"]).quiet(0).json_lines();
    assert_eq!(lines.len(), HEIGHTS.len());
    for (line, (verdict, _, _)) in lines.iter().zip(HEIGHTS) {
        assert_eq!((&line["id"], &line["verdict"]), (&verdict.into(), &verdict.into()));
    }
}

#[test]
fn the_table_has_a_row_a_case() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &good_cases());
    let text = inputs.run(&["batch", "cases.json"]).quiet(0).stdout();
    // A head and a sum, and what is to be doubted: the free one is beside the floor.
    assert_eq!(text.lines().count(), HEIGHTS.len() + 3, "{text}");
    assert!(text.contains("warning in 1 case, first free: the object is outside"), "{text}");
    assert!(text.contains("in collision") && text.contains("floor.pcd / box.obj"), "{text}");
    assert!(text.contains("3 answers, 0 errors"), "{text}");
}

#[test]
fn the_file_has_what_json_prints() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &good_cases());
    let run = inputs.run(&["batch", "cases.json", "--json", "--jsonl", "out.jsonl"]).quiet(0);
    assert_eq!(std::fs::read_to_string(inputs.path("out.jsonl")).unwrap(), run.stdout());
}

#[test]
fn bad_cases_keep_their_place_and_the_rest_goes_on() {
    let inputs = Inputs::new();
    let with = |from: &str, to: &str| {
        let case = case_at("bad", 0.1);
        assert!(case.contains(from));
        case.replace(from, to)
    };
    let cases = [
        ("not a JSON object", "5".to_owned()),
        ("not a JSON object", "null".to_owned()),
        ("missing field `scene`", r#"{"id":"bad"}"#.to_owned()),
        ("`scene` is [\"floor.pcd\"]: write the path", with("\"floor.pcd\"", "[\"floor.pcd\"]")),
        ("`object` is \"\"", with("box.obj", "")),
        ("`object` is NaN: write the path", with("\"box.obj\"", "NaN")),
        ("`scene_sensor` is 5", with("\"iso:0.002\"", "5")),
        ("`scene` is there twice", with("\"scene\"", "\"scene\":\"other.pcd\",\"scene\"")),
        ("gone.pcd: cannot be read", with("floor.pcd", "gone.pcd")),
        ("not a rotation", with("[[1,", "[[2,")),
        ("mirrors", with("[[1,", "[[-1,")),
        ("four rows of four numbers", with("[[1,", "[[null,")),
        ("four rows of four numbers", with("[[1,", "[[1,1,")),
        ("3 rows", with("[[1,0,0,0.01],", "[")),
        ("last row", with("[0,0,0,1]", "[0,0,1,1]")),
        ("unknown sensor `sonar`", with("iso:0.002", "sonar")),
        // Python's json writes the first, any language the second, a broken text the third.
        ("(0, 0) is NaN: every entry must be a finite number", with("[[1,", "[[NaN,")),
        ("(2, 3) is -Infinity", with("[0,0,1,0.1]", "[0,0,1,-Infinity]")),
        ("(0, 0) is \"1\"", with("[[1,", "[[\"1\",")),
        ("number out of range", with("[[1,", "[[1e400,")),
        ("hex escape", with("iso:0.002", "\\ud800")),
    ];
    let named =
        |(i, (_, case)): (usize, &(&str, String))| case.replace("\"bad\"", &format!("\"bad-{i}\""));
    let mut entries: Vec<String> = cases.iter().enumerate().map(named).collect();
    entries.push(case_at("good", 0.5));
    inputs.write("cases.json", &case_file(&entries));
    let run = inputs.run(&["batch", "cases.json", "--json"]).quiet(1);
    let lines = run.json_lines();
    assert_eq!(lines.len(), entries.len());
    for ((expected, case), line) in cases.iter().zip(&lines) {
        let error = line["error"].as_str().unwrap();
        assert!(error.contains(expected), "{case} gives {error}");
        assert!(line.get("verdict").is_none() && line.as_object().unwrap().len() == 2, "{line}");
    }
    assert_eq!((&lines[0]["id"], &lines[1]["id"]), (&"case-1".into(), &"case-2".into()));
    for (i, line) in lines.iter().enumerate().take(cases.len()).skip(2) {
        assert_eq!(line["id"], format!("bad-{i}"), "{line}");
    }
    assert_eq!(lines.last().unwrap()["verdict"], "free");
    let table = inputs.run(&["batch", "cases.json"]).quiet(1).stdout();
    assert!(table.contains("1 answer, 21 errors"), "{table}");
}

#[test]
fn sensors_of_cases_win_over_options() {
    let inputs = Inputs::new();
    let case = case_at("own", 0.11);
    let plain = case.replace(r#""scene_sensor":"iso:0.002","#, "").replace("own", "plain");
    inputs.write("cases.json", &case_file(&[case, plain]));
    let probabilities = |option: &str| {
        let lines = inputs.run(&["batch", "cases.json", "--json", option]).quiet(0).json_lines();
        lines.iter().map(|l| l["collision_probability"].as_f64().unwrap()).collect::<Vec<_>>()
    };
    let [plain, named] = ["--sensor=iso:0.03", "--sensor-for=floor=iso:0.03"].map(probabilities);
    assert_eq!(plain, named);
    assert!(plain[1] > plain[0], "{plain:?}");
    let same = probabilities("--sensor=iso:0.002");
    assert_eq!(same, [plain[0]; 2]);
}

#[test]
fn threads_do_not_change_the_answers() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &good_cases());
    let answers = |threads: &str| {
        let mut command = assert_cmd::Command::cargo_bin("cloudtouch").unwrap();
        let output = command
            .env("RAYON_NUM_THREADS", threads)
            .args(["batch", "--json"])
            .arg(inputs.path("cases.json"))
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout).unwrap();
        let lines =
            text.lines().map(|line| line.split("\"prepare_us\"").next().unwrap().to_owned());
        lines.collect::<Vec<_>>()
    };
    assert_eq!(answers("1"), answers("3"));
}

#[test]
fn what_a_case_does_not_need_does_not_fail_it() {
    let inputs = Inputs::new();
    let add = |id: &str, field: &str| case_at(id, 0.5).replacen('{', &format!("{{{field},"), 1);
    let cases = [
        add("a", r#""label":3"#),
        add("b", r#""in_collision":"no""#),
        add("c", r#""signed_distance_m":NaN"#),
        add("d", r#""note":[Infinity,-Infinity,NaN,"NaN, \" and NaN"]"#),
        case_at("a", 0.5).replace(r#""id":"a""#, r#""id":null"#),
        case_at("tab\\tbell\\u0007\\n\\u001b[31m", 0.5),
    ];
    // A byte order mark, as of Windows.
    inputs.write("cases.json", &format!("\u{feff}{}", case_file(&cases)));
    let lines = inputs.run(&["batch", "cases.json", "--json"]).quiet(0).json_lines();
    assert!(lines.iter().all(|line| line["verdict"] == "free"), "{lines:?}");
    assert_eq!(lines[4]["id"], "case-5");
    assert_eq!(lines[5]["id"], "tab\tbell\u{7}\n\u{1b}[31m");
    let table = inputs.run(&["batch", "cases.json"]).quiet(0).stdout();
    assert_eq!(table.lines().count(), cases.len() + 3, "{table}");
    assert!(table.contains(r"\u{1b}[31m") && !table.contains('\u{1b}'), "{table}");
}

/// Only the JSON had them.
#[test]
fn warnings_and_guessed_sensors_are_told_beside_the_table() {
    let inputs = Inputs::new();
    let cases = case_file(&[case_at("a", 0.3), case_at("b", 0.05)]);
    inputs.write("cases.json", &cases.replace("\"scene_sensor\":\"iso:0.002\",", ""));
    let text = inputs.run(&["batch", "cases.json", "--sensor=kinect"]).quiet(0).stdout();
    let warning = "warning in 2 cases, first a: the scene has no rows and columns";
    assert!(text.contains(warning), "{text}");
    let text = inputs.run(&["batch", "cases.json", "--sensor=auto"]).quiet(0).stdout();
    let first = text.lines().next().unwrap();
    assert!(first.contains("floor.pcd: sensor ") && first.contains('('), "{text}");
}

#[test]
fn an_input_is_never_replaced_and_another_file_only_when_asked() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &good_cases());
    inputs.write("old.jsonl", "old");
    for output in ["cases.json", "floor.pcd", "./box.obj"] {
        let run = inputs.run(&["batch", "cases.json", "--jsonl", output, "--force"]);
        assert_eq!((run.code(), run.stdout().as_str()), (1, ""), "{output}");
        assert!(run.stderr().contains("is an input"), "{}", run.stderr());
    }
    let refused = inputs.run(&["batch", "cases.json", "--jsonl", "old.jsonl"]);
    assert!(refused.code() == 1 && refused.stderr().contains("--force"), "{}", refused.stderr());
    assert_eq!(std::fs::read_to_string(inputs.path("old.jsonl")).unwrap(), "old");
    inputs.run(&["batch", "cases.json", "--jsonl", "old.jsonl", "--force"]).quiet(0);
    assert_ne!(std::fs::read_to_string(inputs.path("old.jsonl")).unwrap(), "old");
}

/// A sensor that was never read made the answer that of another one.
#[test]
fn a_misspelt_field_of_a_case_was_passed_over() {
    let inputs = Inputs::new();
    let case = |id: &str, from: &str, to: &str| case_at(id, 0.5).replacen(from, to, 1);
    let misspelt = [
        ("scene_sensor", "scene_senser"),
        ("scene_sensor", "sceneSensor"),
        ("scene_sensor", "scene_sensors"),
        ("object_sensor", "obj_sensor"),
        ("object_sensor", "object-sensor"),
        ("pose", "poze"),
        ("object", "Object"),
        ("id", "ID"),
    ];
    let mut cases: Vec<String> = misspelt
        .iter()
        .enumerate()
        .map(|(i, (known, given))| {
            let from = if *known == "object_sensor" { "scene_sensor" } else { known };
            case(&format!("c{i}"), &format!("\"{from}\""), &format!("\"{given}\""))
        })
        .collect();
    // Names of other things, and of a second one beside the first.
    let other = r#""scene_points_used":"finite","object_kind":"mesh","pose_stamp":1,"poses":2,"ids":3,"sensor":"a note","margin":{"margin_m":1},"id""#;
    cases.push(case("good", "\"id\"", other));
    inputs.write("cases.json", &case_file(&cases));
    let lines = inputs.run(&["batch", "cases.json", "--json"]).quiet(1).json_lines();
    for ((known, given), line) in misspelt.iter().zip(&lines) {
        let error = line["error"].as_str().unwrap_or_else(|| panic!("{given}: {line}"));
        for part in [format!("`{given}`"), format!("`{known}`")] {
            assert!(error.contains(&part), "{error}");
        }
    }
    assert_eq!(lines[misspelt.len()]["verdict"], "free");
}

#[test]
fn a_sensor_beside_the_cases_was_passed_over() {
    let inputs = Inputs::new();
    for name in ["scene_sensor", "object_sensor"] {
        let cases = case_file(&[case_at("a", 0.5)]);
        inputs.write("cases.json", &cases.replacen('{', &format!("{{\"{name}\":\"kinect\","), 1));
        let run = inputs.run(&["batch", "cases.json"]);
        let error = run.stderr();
        assert_eq!((run.code(), run.stdout().as_str()), (1, ""), "{error}");
        for part in [&format!("`{name}`"), "cases.json", "each case", "--sensor"] {
            assert!(error.contains(part), "`{part}` is not in {error}");
        }
    }
}

/// Scene files have the first two and the options the rest: in a case they changed nothing.
#[test]
fn a_field_of_a_scene_file_or_of_an_option_was_passed_over_in_a_case() {
    let inputs = Inputs::new();
    let of_others = [
        ("sensor", "\"iso:0.002\"", &["`scene_sensor`", "`object_sensor`"][..]),
        ("Sensor", "\"iso:0.002\"", &["`scene_sensor`", "`object_sensor`"]),
        ("unit", "\"mm\"", &["--unit", "--cloud-unit"]),
        ("mesh_unit", "\"m\"", &["--unit", "--cloud-unit"]),
        ("object_unit", "\"mm\"", &["--unit", "--cloud-unit"]),
        ("cloud_unit", "\"mm\"", &["--cloud-unit"]),
        ("margin", "0.1", &["option"]),
        ("threshold", "0.0001", &["--reject"]),
        ("reject", "0.01", &["option"]),
        ("max-unseen", "0.5", &["option"]),
        ("sensor_pose", "[0,0,1]", &["option"]),
        ("translate", "[0,0,1]", &["`pose`"]),
        ("maxUnseen", "0.5", &["option"]),
        ("treshold", "0.01", &["--reject"]),
        ("units", "\"mm\"", &["--unit"]),
        ("length_unit", "\"mm\"", &["--unit"]),
        ("scale", "0.001", &["--unit"]),
    ];
    let with = |(i, (name, value, _)): (usize, &(&str, &str, &[&str]))| {
        let field = format!("\"{name}\":{value}");
        case_at(&format!("c{i}"), 0.5).replace("\"scene_sensor\":\"iso:0.002\"", &field)
    };
    let mut cases: Vec<String> = of_others.iter().enumerate().map(with).collect();
    cases.push(case_at("good", 0.5));
    inputs.write("cases.json", &case_file(&cases));
    let lines = inputs.run(&["batch", "cases.json", "--json"]).quiet(1).json_lines();
    for ((name, _, parts), line) in of_others.iter().zip(&lines) {
        let error = line["error"].as_str().unwrap_or_else(|| panic!("{name}: {line}"));
        assert!(error.contains(&format!("`{name}`")), "{error}");
        assert!(parts.iter().all(|part| error.contains(part)), "{parts:?}: {error}");
    }
    assert_eq!(lines[of_others.len()]["verdict"], "free");
    // Beside the cases the length unit belongs.
    for (name, value, parts) in of_others.into_iter().filter(|(name, ..)| *name != "length_unit") {
        let beside = format!("{{\"{name}\":{value},");
        inputs.write("cases.json", &case_file(&[case_at("a", 0.5)]).replacen('{', &beside, 1));
        let run = inputs.run(&["batch", "cases.json"]);
        let error = run.stderr();
        assert_eq!((run.code(), run.stdout().as_str()), (1, ""), "{name}: {error}");
        assert!(error.contains("cases.json") && error.contains(&format!("`{name}`")), "{error}");
        assert!(parts.iter().all(|part| error.contains(part)), "{parts:?}: {error}");
    }
}

/// Whoever looks an answer up by its name found another one.
#[test]
fn two_cases_of_one_name_were_not_told() {
    let inputs = Inputs::new();
    let unnamed = case_at("x", 0.05).replace(r#""id":"x","#, "");
    let ids = ["a", "b", "a", "case-5"].map(|id| case_at(id, 0.5));
    inputs.write("cases.json", &case_file(&[&ids[..], &[unnamed]].concat()));
    let run = inputs.run(&["batch", "cases.json", "--json"]);
    assert_eq!((run.code(), run.json_lines().len()), (0, 5), "{}", run.stderr());
    for part in ["cases.json", "cases 1 and 3", "`a`", "cases 4 and 5", "`case-5`", "order"] {
        assert!(run.stderr().contains(part), "`{part}` is not in {}", run.stderr());
    }
}

/// It had no use, or was the reason why all cases of a file that is gone were refused.
#[test]
fn options_are_refused_where_no_file_has_a_use_for_them_and_all_are_read() {
    let inputs = Inputs::new();
    let plain = |id: &str| case_at(id, 0.5).replace("\"scene_sensor\":\"iso:0.002\",", "");
    let meshes = plain("a").replace("floor.pcd", "box.obj");
    for (case, option, part) in [
        (&meshes, "--sensor=iso:0.002", "--sensor is for clouds"),
        (&meshes, "--sensor-for=box=iso:0.002", "is for clouds"),
        (&plain("a"), "--sensor-for=box=iso:0.002", "--sensor-for box=iso:0.002 is for clouds"),
        (&plain("a"), "--object-sensor=iso:0.002", "--object-sensor is for"),
    ] {
        inputs.write("cases.json", &case_file(std::slice::from_ref(case)));
        let run = inputs.run(&["batch", "cases.json", option]);
        assert_eq!((run.code(), run.stdout().as_str()), (2, ""), "{option}: {}", run.stderr());
        assert!(run.stderr().contains(part), "{}", run.stderr());
    }
    // What cannot be read may be a cloud.
    let gone = plain("gone").replace("floor.pcd", "gone.pcd");
    inputs.write("cases.json", &case_file(&[meshes, gone]));
    let lines = inputs.run(&["batch", "cases.json", "--json", "--sensor=iso:0.002"]).quiet(1);
    assert_eq!(lines.json_lines().len(), 2);
}

/// It was an unknown sensor there, and known to options and scene files.
#[test]
fn auto_was_no_sensor_in_a_case() {
    let inputs = Inputs::new();
    let case = case_at("own", 0.5).replace("iso:0.002", "auto");
    inputs.write("cases.json", &case_file(&[case]));
    let lines = inputs.run(&["batch", "cases.json", "--json"]).quiet(0).json_lines();
    assert_eq!(lines[0]["scene"]["sensor"], "iso:0.005", "{}", lines[0]);
    assert_eq!(lines[0]["scene"]["sensor_because"], "nothing in the file tells");
}

/// Each case had a sensor of its own, and the one given beside them was passed over in silence.
#[test]
fn a_sensor_that_no_cloud_goes_by_is_told() {
    let inputs = Inputs::new();
    let own = case_at("own", 0.11);
    let plain = own.replace(r#""scene_sensor":"iso:0.002","#, "").replace("own", "plain");
    inputs.write("own.json", &case_file(std::slice::from_ref(&own)));
    inputs.write("mixed.json", &case_file(&[own, plain]));
    for option in ["--sensor=iso:0.03", "--sensor-for=floor=iso:0.03"] {
        let run = inputs.run(&["batch", "own.json", option]);
        let told = format!("own.json: {} is of no cloud", option.replacen('=', " ", 1));
        assert_eq!(run.code(), 0, "{}", run.stderr());
        assert!(run.stderr().contains(&told), "{told}: {}", run.stderr());
        inputs.run(&["batch", "mixed.json", option]).quiet(0);
    }
}

/// A typo gave the usual noise, and the name of the folder that all is in gave every file that sensor.
#[test]
fn a_sensor_for_no_file_was_taken_in_silence() {
    let inputs = Inputs::new();
    let plain = case_at("a", 0.5).replace("\"scene_sensor\":\"iso:0.002\",", "");
    std::fs::create_dir(inputs.path("kinect")).unwrap();
    for name in ["floor.pcd", "box.obj"] {
        std::fs::copy(inputs.path(name), inputs.path("kinect").join(name)).unwrap();
    }
    inputs.write("kinect/cases.json", &case_file(std::slice::from_ref(&plain)));
    for name in ["flor", "kinect"] {
        let run =
            inputs.run(&["batch", "kinect/cases.json", &format!("--sensor-for={name}=kinect")]);
        assert_eq!((run.code(), run.stdout().as_str()), (2, ""), "{}", run.stderr());
        for part in
            [&format!("--sensor-for {name}=kinect"), "kinect/cases.json", "box.obj, floor.pcd"]
        {
            assert!(run.stderr().contains(part), "{part}: {}", run.stderr());
        }
    }
    inputs.run(&["batch", "kinect/cases.json", "--sensor-for=floor=iso:0.002"]).quiet(0);
    // What cannot be read may name the file.
    inputs.write("cases.json", &case_file(&[plain, "5".to_owned()]));
    inputs.run(&["batch", "cases.json", "--sensor-for=flor=iso:0.002"]).quiet(1);
}

#[test]
fn a_sensor_of_a_mesh_was_passed_over_in_a_case() {
    let inputs = Inputs::new();
    let case = case_at("a", 0.5).replace("scene_sensor", "object_sensor");
    inputs.write("cases.json", &case_file(&[case, case_at("b", 0.5)]));
    let run = inputs.run(&["batch", "cases.json", "--json"]);
    let told = run.stderr();
    assert!(told.contains("`object_sensor`") && told.contains("box.obj is a mesh"), "{told}");
    let lines = run.json_lines();
    // Programs write the same fields for all: neither is refused.
    assert_eq!(lines[0]["verdict"], "free");
    assert_eq!(lines[1]["verdict"], "free");
}

/// Scans of a series often have one name, each in a folder of its own.
#[test]
fn files_of_one_name_in_two_folders_looked_the_same_in_the_table_and_on_the_page() {
    let inputs = Inputs::new();
    let files = ["a/floor.pcd", "b/floor.pcd"];
    for (folder, file) in ["a", "b"].into_iter().zip(files) {
        std::fs::create_dir(inputs.path(folder)).unwrap();
        std::fs::copy(inputs.path("floor.pcd"), inputs.path(file)).unwrap();
    }
    let cases =
        files.map(|file| case_at(file, 0.5).replacen("\"floor.pcd", &format!("\"{file}"), 1));
    inputs.write("cases.json", &case_file(&cases));
    let table = inputs.run(&["batch", "cases.json", "--html=o.html"]).quiet(0).stdout();
    let page = page(&inputs, "o.html");
    for file in files {
        assert!(table.contains(&format!("{file} / box.obj")), "{table}");
        assert!(page.contains(&format!("<dt>Scene</dt><dd>{file}: cloud of ")), "{file}");
    }
    assert!(page.contains("<dt>Object</dt><dd>box.obj: "));
}

#[test]
fn one_long_name_made_every_row_of_the_table_as_long() {
    let inputs = Inputs::new();
    let cases = ["short", &"long".repeat(500)].map(|id| case_at(id, 0.5));
    inputs.write("cases.json", &case_file(&cases));
    let table = inputs.run(&["batch", "cases.json"]).quiet(0).stdout();
    let row = table.lines().find(|row| row.starts_with("short")).unwrap();
    assert!(row.chars().count() < 200, "{row}");
}

/// The file beside was blamed, with no word of the reason.
#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_told_as_such() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &good_cases());
    for more in [&[][..], &["--json"], &["--jsonl=out.jsonl"]] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_cloudtouch"));
        command.current_dir(inputs.path("")).args(["batch", "cases.json"]).args(more);
        let run = command.stdout(full).output().unwrap();
        let told = String::from_utf8(run.stderr).unwrap();
        let start = "error: standard output: cannot be written: No space left";
        assert!(run.status.code() == Some(1) && told.starts_with(start), "{more:?}: {told}");
        assert!(!inputs.names().contains(&"out.jsonl".to_owned()));
    }
}

/// They were passed over, and the answers were of all points.
#[test]
fn further_options_in_a_case_were_passed_over() {
    let inputs = Inputs::new();
    let with = |field: &str| case_at("a", 0.5).replacen('{', &format!("{{{field},"), 1);
    for (field, part) in [
        ("\"collision_map\": 0.05", "as an option of the command"),
        ("\"outliers\": [8, 3]", "as an option of the command"),
        ("\"keep_veil\": true", "as an option of the command"),
        ("\"pose_std\": [0.01,0.01,0.01,0,0,0]", "by `cloudtouch query`"),
        ("\"pose-std\": \"0.01,0.01,0.01,0,0,0\"", "by `cloudtouch query`"),
        ("\"also\": [\"shelf.xyz\"]", "with --also"),
        ("\"scene_pose\": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]", "all of the pose"),
    ] {
        inputs.write("cases.json", &case_file(&[with(field)]));
        let line = inputs.run(&["batch", "cases.json", "--json"]).quiet(1).json_lines().remove(0);
        assert!(line["error"].as_str().is_some_and(|error| error.contains(part)), "{line}");
    }
}
