//! `cloudtouch scene`: boxes over a floor, one on another's back.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::{HEIGHTS, Inputs, Run};
use serde_json::{Value, json};

/// A body at a height, away from the rows of the floor.
fn body(name: &str, file: &str, height: f64) -> Value {
    let pose = [
        [1.0, 0.0, 0.0, 0.01],
        [0.0, 1.0, 0.0, 0.02],
        [0.0, 0.0, 1.0, height],
        [0.0, 0.0, 0.0, 1.0],
    ];
    json!({"name": name, "file": file, "pose": pose})
}

fn floor() -> Value {
    json!({"name": "floor", "file": "floor.pcd", "sensor": "iso:0.002"})
}

fn of_bodies(bodies: &[Value]) -> Value {
    json!({"format": 1, "length_unit": "m", "bodies": bodies})
}

fn scene(inputs: &Inputs, scene: &Value, more: &[&str]) -> Run {
    inputs.write("scene.json", &scene.to_string());
    inputs.run(&[&["scene", "scene.json"], more].concat())
}

fn pairs(answer: &Value) -> Vec<[&str; 2]> {
    let all = answer["pairs"].as_array().unwrap();
    all.iter().map(|pair| ["a", "b"].map(|key| pair[key].as_str().unwrap())).collect()
}

#[test]
fn the_worst_verdict_is_the_exit_code_and_answers_are_those_of_query() {
    let inputs = Inputs::new();
    for (verdict, code, height) in HEIGHTS {
        let bodies = [floor(), body("box", "box.obj", height), body("bird", "box.obj", 5.0)];
        let run = scene(&inputs, &of_bodies(&bodies), &["--json", "--exit-code"]).quiet(code);
        let answer = run.json_lines().remove(0);
        assert_eq!(answer["verdict"], verdict);
        assert_eq!(answer["counts"]["pairs"], 3);
        let Some(pair) = answer["pairs"].get(0) else {
            assert_eq!((verdict, &answer["counts"]["ruled_out"]), ("free", &json!(3)));
            continue;
        };
        assert_eq!(pairs(&answer), [["floor", "box"]]);
        let alone = inputs.query_at(height, &["--json"]).json_lines().remove(0);
        for key in ["collision_probability", "bounds", "verdict", "contacts", "evidence"] {
            assert_eq!(pair[key], alone[key], "{key}");
        }
        scene(&inputs, &of_bodies(&bodies), &[]).quiet(0);
    }
}

#[test]
fn what_is_attached_is_placed_by_what_carries_it_and_allowed_pairs_may_touch() {
    let inputs = Inputs::new();
    // The load is half a metre below its carrier: at the floor.
    let mut load = body("load", "box.obj", -0.55);
    load["attached_to"] = json!("carrier");
    let mut file = of_bodies(&[floor(), load, body("carrier", "box.obj", 0.6)]);
    let answer = scene(&inputs, &file, &["--json", "--exit-code"]).quiet(20).json_lines().remove(0);
    assert_eq!(pairs(&answer), [["floor", "load"]]);
    let text = scene(&inputs, &file, &[]).quiet(0).stdout();
    assert!(
        text.contains("load: watertight mesh") && text.contains("attached to carrier"),
        "{text}"
    );
    assert!(text.contains("floor / load"), "{text}");
    assert!(text.contains("in collision: 1 of 3 pairs may be at or above 0.100"), "{text}");
    file["allowed"] = json!([["load", "floor"]]);
    let answer = scene(&inputs, &file, &["--json", "--exit-code"]).quiet(0).json_lines().remove(0);
    assert_eq!((pairs(&answer).len(), &answer["counts"]["allowed"]), (0, &json!(1)));
    file["allowed"] = json!([["load", "floor"], ["carrier", "floor"]]);
    // Of the floor nothing was checked, and that went without a word.
    let words = "nothing was asked about floor: all its pairs may touch by what was said";
    let text = scene(&inputs, &file, &[]).quiet(0).stdout();
    assert!(text.contains(words) && text.contains("free: 0 of 3 pairs"), "{text}");
    let answer = scene(&inputs, &file, &["--json"]).quiet(0).json_lines().remove(0);
    assert_eq!(answer["unchecked"], json!(["floor"]));
    let all = json!([["load", "floor"], ["carrier", "floor"], ["carrier", "load"]]);
    file["allowed"] = all;
    // Nothing was checked, and it read as free.
    let run = scene(&inputs, &file, &["--exit-code"]);
    assert!(run.code() == 30 && run.stderr().contains("none was asked about"), "{}", run.stderr());
    let text = run.stdout();
    assert!(text.contains("undecided: all pairs may touch") && !text.contains("free"), "{text}");
    let answer = scene(&inputs, &file, &["--json"]).json_lines().remove(0);
    assert_eq!([&answer["verdict"], &answer["undecided_by"]], ["undecided", "unchecked"]);
}

/// The table had the verdict of a pair, and only JSON why and what mends it.
#[test]
fn what_mends_a_pair_is_told_below_the_table() {
    let inputs = Inputs::new();
    // A coarse floor says nothing of what fits between its samples.
    let coarse: String = (0..400)
        .map(|k| format!("{} {} 0\n", 0.5 * f64::from(k % 20), 0.5 * f64::from(k / 20)))
        .collect();
    inputs.write("coarse.xyz", &coarse);
    let file = of_bodies(&[body("coarse", "coarse.xyz", 0.0), body("box", "box.obj", 0.4)]);
    let text = scene(&inputs, &file, &[]).quiet(0).stdout();
    let warned = "warning                coarse / box: points of the scene are ";
    assert!(text.contains("undecided") && text.matches(warned).count() == 1, "{text}");
}

#[test]
fn units_sensors_and_the_threshold_are_those_of_the_file() {
    let inputs = Inputs::new();
    let mut small = body("box", "box.obj", 0.1);
    small["unit"] = json!("cm");
    let answer = scene(&inputs, &of_bodies(&[floor(), small]), &["--json"]).quiet(0);
    let answer = answer.json_lines().remove(0);
    assert_eq!(answer["bodies"]["box"]["unit"], "cm");
    assert_eq!(answer["bodies"]["floor"]["sensor"], "iso:0.002");
    let mut file = of_bodies(&[floor(), body("box", "box.obj", 5.0)]);
    assert_eq!(answer["threshold"], 0.1);
    file["threshold"] = json!(0.00001);
    let answer = scene(&inputs, &file, &["--json"]).quiet(0).json_lines().remove(0);
    assert_eq!((answer["threshold"].as_f64(), pairs(&answer).len()), (Some(0.00001), 1));
    let both = scene(&inputs, &file, &["--reject", "0.2"]);
    assert!(both.code() == 2 && both.stderr().contains("give one of them"), "{}", both.stderr());
}

#[test]
fn bad_scenes_are_refused_with_file_place_value_and_remedy() {
    let inputs = Inputs::new();
    inputs.write("nan.xyz", "nan nan nan\nnan nan nan\n");
    let with = |key: &str, value: Value| {
        let mut changed = body("box", "box.obj", 1.0);
        changed[key] = value;
        of_bodies(&[floor(), changed])
    };
    let of_scene = |key: &str, value: Value| {
        let mut file = of_bodies(&[floor(), body("box", "box.obj", 1.0)]);
        file[key] = value;
        file
    };
    for (file, parts) in [
        (with("name", json!("")), vec!["body 2", "`name` is empty"]),
        (with("file", json!("nan.xyz")), vec!["body 2 `box`", "nan.xyz", "no point is left"]),
        (with("name", json!("floor")), vec!["body 2", "`floor`", "another name"]),
        (with("attached_to", json!("hand")), vec!["body 2", "`hand`", "name a body of the file"]),
        (with("attached_to", json!("box")), vec!["body 2", "`box`", "detach"]),
        (with("file", json!("gone.obj")), vec!["body 2 `box`", "gone.obj", "cannot be read"]),
        (with("file", json!("scene.json")), vec!["body 2 `box`", "scene.json"]),
        (with("file", json!(["box.obj"])), vec!["body 2 `box`", "`file` is [\"box.obj\"]"]),
        (with("unit", json!(1)), vec!["body 2 `box`", "`unit` is 1"]),
        // As programs write what they do not know: it was where no pose is given.
        (with("pose", Value::Null), vec!["body 2 `box`", "the pose is null"]),
        (with("attached_to", Value::Null), vec!["body 2 `box`", "`attached_to` is null"]),
        (of_scene("bodies", json!([["a", "b"], 1])), vec!["body 1", "a JSON object"]),
        (with("sensor", json!("sonar")), vec!["body 2 `box`", "`sonar`"]),
        (with("unit", json!("miles")), vec!["body 2 `box`", "miles"]),
        (with("pose", json!([[1, 0, 0, 0]])), vec!["body 2 `box`", "1 rows", "four rows of four"]),
        (
            with("pose", json!([[1, 0, 0, 0], [0, 1, 0, 3e11], [0, 0, 1, 0], [0, 0, 0, 1]])),
            vec!["body 2 `box`", "(1, 3) is 3e11", "in metres"],
        ),
        (with("pose", json!("here")), vec!["body 2 `box`", "four rows of four numbers"]),
        (with("atached_to", json!("floor")), vec!["body 2 `box`", "`atached_to`", "`attached_to`"]),
        (
            of_scene("allowed", json!([["box", "wall"]])),
            vec!["pair 1 of \"allowed\"", "`wall`", "of the file"],
        ),
        (of_scene("allowed", json!([["box"]])), vec!["pair 1 of \"allowed\"", "two names"]),
        (of_scene("threshold", json!(0.7)), vec!["threshold 0.7", "0 to 0.5"]),
        (of_scene("format", json!(2)), vec!["format 2", "format 1"]),
        (of_scene("length_unit", json!("mm")), vec!["length_unit `mm`", "metres"]),
        (of_scene("bodies", json!([])), vec!["no bodies: ", "at least two"]),
    ] {
        let run = scene(&inputs, &file, &[]);
        let error = run.stderr();
        assert_eq!((run.code(), run.stdout().as_str()), (1, ""), "{error}");
        assert!(error.starts_with("error: scene.json: "), "{error}");
        assert!(parts.iter().all(|part| error.contains(part)), "{parts:?}: {error}");
    }
    let text = of_bodies(&[floor(), body("box", "box.obj", 1.25)]).to_string();
    inputs.write("twice.json", &text.replace("\"box\"", "\"box\",\"name\":\"tool\""));
    let run = inputs.run(&["scene", "twice.json"]);
    assert!(run.stderr().contains(": `name` is there twice: leave"), "{}", run.stderr());
    // What Python writes for a number that is none.
    let text =
        of_bodies(&[floor(), body("box", "box.obj", 1.25)]).to_string().replace("1.25", "NaN");
    inputs.write("nan.json", &text);
    let run = inputs.run(&["scene", "nan.json"]);
    assert!(run.code() == 1 && run.stderr().contains("body 2 `box`"), "{}", run.stderr());
    for (options, part) in [
        (["--mode", "paper"], "calibrated mode"),
        (["--margin", "0.1"], "--margin"),
        (["--sensor-pose", "0,0,1"], "--sensor-pose"),
    ] {
        let run = scene(&inputs, &of_bodies(&[floor()]), &options);
        assert!(run.code() == 2 && run.stderr().contains(part), "{}", run.stderr());
    }
}

#[test]
fn sensors_without_a_cloud_were_passed_over() {
    let inputs = Inputs::new();
    let of_a_mesh = {
        let mut with = body("box", "box.obj", 0.5);
        with["sensor"] = json!("iso:0.002");
        of_bodies(&[floor(), with])
    };
    let plain = of_bodies(&[floor(), body("box", "box.obj", 0.5)]);
    for (file, options, code, parts) in [
        (&of_a_mesh, &[][..], 1, ["body 2 `box`", "`sensor`", "box.obj is a mesh"]),
        (
            &plain,
            &["--sensor=iso:0.03"],
            2,
            ["--sensor is for", "each cloud has one", "leave it out"],
        ),
    ] {
        let run = scene(&inputs, file, options);
        assert_eq!((run.code(), run.stdout().as_str()), (code, ""), "{}", run.stderr());
        assert!(parts.iter().all(|part| run.stderr().contains(part)), "{}", run.stderr());
    }
    let mut own = floor();
    own["sensor"] = Value::Null;
    scene(&inputs, &of_bodies(&[own, body("box", "box.obj", 0.5)]), &["--sensor=iso:0.03"])
        .quiet(0);
}

/// What is undecided for want of it could not be told where the sensor stood.
#[test]
fn where_a_sensor_stood_decides_whether_a_cloud_is_hollow() {
    let inputs = Inputs::new();
    let of_sphere = |k: u32| {
        let (z, turn) = (1.0 - (f64::from(k) + 0.5) / 1000.0, 2.4 * f64::from(k));
        let (sin, cos) = turn.sin_cos();
        let across = (1.0 - z * z).sqrt();
        format!("{} {} {z}\n", across * cos, across * sin)
    };
    inputs.write("shell.xyz", &(0..2000).map(of_sphere).collect::<String>());
    let mut shell = json!({"name": "shell", "file": "shell.xyz", "sensor": "iso:0.005"});
    let box_within = body("box", "box.obj", 0.5);
    let file = of_bodies(&[shell.clone(), box_within.clone()]);
    let text = scene(&inputs, &file, &[]).quiet(0).stdout();
    assert!(text.contains("undecided") && text.contains("in a scene file `sensor_pose`"), "{text}");
    let pose = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]];
    shell["sensor_pose"] = json!(pose);
    let file = of_bodies(&[shell.clone(), box_within.clone()]);
    let text = scene(&inputs, &file, &[]).quiet(0).stdout();
    assert!(text.contains("free: 0 of 1 pairs"), "{text}");
    shell["sensor_pose"] = json!(pose[..3]);
    let run = scene(&inputs, &of_bodies(&[shell.clone(), box_within.clone()]), &[]);
    assert_eq!(run.code(), 1);
    for part in ["body 1 `shell`", "`sensor_pose`", "the pose has 3 rows"] {
        assert!(run.stderr().contains(part), "{}", run.stderr());
    }
    // It was refused as an option, which the command does not have.
    shell["sensor_pose"] = json!(pose);
    let mut of_mesh = box_within;
    of_mesh["sensor_pose"] = json!(pose);
    let run = scene(&inputs, &of_bodies(&[shell, of_mesh]), &[]);
    let error = run.stderr();
    for part in ["body 2 `box`", "`sensor_pose` is of a cloud", "box.obj is a mesh", "leave it out"]
    {
        assert!(error.contains(part) && !error.contains("--sensor-pose"), "{error}");
    }
    assert_eq!(run.code(), 1);
}

/// They were of no body, and nothing said so: whoever gave them meant one.
#[test]
fn units_and_cameras_were_passed_over_where_each_body_has_its_own() {
    let inputs = Inputs::new();
    let with = |mut body: Value, unit: &str| {
        body["unit"] = json!(unit);
        body
    };
    let (flat, cube) = (floor(), body("box", "box.obj", 0.5));
    let own = of_bodies(&[with(flat.clone(), "m"), with(cube.clone(), "m")]);
    for (option, parts) in [
        ("--unit=mm", ["--unit is for meshes without a `unit`", "each mesh has one: leave it out"]),
        ("--cloud-unit=mm", ["--cloud-unit is for clouds without a `unit`", "each cloud has one"]),
    ] {
        let run = scene(&inputs, &own, &[option]);
        assert_eq!((run.code(), run.stdout().as_str()), (2, ""), "{}", run.stderr());
        assert!(parts.iter().all(|part| run.stderr().contains(part)), "{}", run.stderr());
    }
    // One that has none is what they are for.
    let other = body("other", "box.obj", 0.8);
    scene(&inputs, &of_bodies(&[flat.clone(), with(cube.clone(), "cm"), other]), &["--unit=cm"])
        .quiet(0);
    scene(&inputs, &of_bodies(&[flat, with(cube, "m")]), &["--cloud-unit=m"]).quiet(0);
}

/// It was replaced by the page.
#[test]
fn the_intrinsics_of_a_body_are_an_input() {
    let inputs = Inputs::new();
    inputs.write("camera", "{}");
    let mut image = body("image", "depth.png", 0.5);
    image["intrinsics"] = json!("camera");
    let run = scene(&inputs, &of_bodies(&[floor(), image]), &["--html=camera", "--force"]);
    assert!(run.code() == 1 && run.stderr().contains("is an input"), "{}", run.stderr());
    for command in [
        &["path", "floor.pcd", "box.obj", "--poses=p.csv"][..],
        &["robot", "floor.pcd", "arm.urdf", "--joints=j.json"],
    ] {
        let more = ["--intrinsics=camera", "--html=camera", "--force"];
        let run = inputs.run(&[command, &more].concat());
        assert!(run.stderr().contains("is an input"), "{command:?}: {}", run.stderr());
    }
}
