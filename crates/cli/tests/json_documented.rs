//! The README tells exactly the keys that the commands print.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeSet;

use crate::support::Inputs;
use cloudtouch::{Warning, Which};
use serde_json::{Value, json};

const README: &str = include_str!("../README.md");

/// A row of a table: a key, whether it comes only with an option, and the keys of the objects in it.
struct Row {
    key: String,
    is_optional: bool,
    inner: Option<BTreeSet<String>>,
}

/// The table under a heading of the README.
fn documented(heading: &str) -> Vec<Row> {
    let (_, section) = README.split_once(&format!("\n### {heading}\n")).unwrap();
    let section = section.split("\n#").next().unwrap();
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
    let rows = rows.flat_map(|line| {
        let (keys, value) = line.split_once("` | ").unwrap();
        let inner = value.split_once("{\"").map(|(_, list)| {
            let (list, _) = list.split_once("\"}").unwrap();
            list.split("\",\"").map(str::to_owned).collect()
        });
        let is_optional = value.starts_with("with `--");
        let row = move |key: &str| Row { key: key.to_owned(), is_optional, inner: inner.clone() };
        keys.split("`, `").map(row).collect::<Vec<Row>>()
    });
    rows.collect()
}

/// Checks the keys of answers against a table; every list of inner keys must have been met.
fn check(heading: &str, answers: &[Value]) {
    let rows = documented(heading);
    assert!(rows.len() >= 5, "{heading}");
    for answer in answers {
        let printed = keys(answer);
        let of = |rows: &mut dyn Iterator<Item = &Row>| -> BTreeSet<String> {
            rows.map(|row| row.key.clone()).collect()
        };
        let undocumented: Vec<_> = printed.difference(&of(&mut rows.iter())).cloned().collect();
        assert_eq!(undocumented, [""; 0], "{heading}: printed, not documented");
        let needed = of(&mut rows.iter().filter(|row| !row.is_optional));
        let missing: Vec<_> = needed.difference(&printed).cloned().collect();
        assert_eq!(missing, [""; 0], "{heading}: documented, not printed");
    }
    for row in rows {
        let values = answers.iter().filter_map(|answer| answer.get(&row.key));
        let objects: Vec<&Value> = values.flat_map(|value| objects(&row.key, value)).collect();
        if let Some(inner) = &row.inner {
            assert!(!objects.is_empty(), "{heading}: no {} was printed", row.key);
            for object in objects {
                assert_eq!(&keys(object), inner, "{heading}: {}", row.key);
            }
        } else {
            assert!(objects.is_empty(), "{heading}: {} has keys: document them", row.key);
        }
    }
}

/// The objects that a value is, or has in its list or by names that are not fixed.
fn objects<'a>(key: &str, value: &'a Value) -> Vec<&'a Value> {
    match value {
        Value::Object(named) if key == "bodies" => named.values().collect(),
        // Corners by the names of bodies.
        Value::Object(_) if key == "boxes" => Vec::new(),
        Value::Object(_) => vec![value],
        Value::Array(list) => list.iter().filter(|entry| entry.is_object()).collect(),
        _ => Vec::new(),
    }
}

fn keys(value: &Value) -> BTreeSet<String> {
    value.as_object().unwrap().keys().cloned().collect()
}

#[test]
fn keys_of_a_query_are_documented() {
    let inputs = Inputs::new();
    let ask = |height, more: &[&str]| {
        let more = [&["--json"], more].concat();
        inputs.query_at(height, &more).quiet(0).json_lines().remove(0)
    };
    // A depth image with a hole, of a wall a metre away; no unit is doubted here.
    let row = |i: usize| match (i % 20, i / 20) {
        (4, 3) => "nan nan nan\n".to_owned(),
        (x, y) => format!("{} {} 1\n", 0.02 * x as f64 - 0.2, 0.02 * y as f64 - 0.1),
    };
    let header = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 20\nHEIGHT 10\n\
                  VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 200\nDATA ascii\n";
    inputs.write("wall.pcd", &(header.to_owned() + &(0..200).map(row).collect::<String>()));
    let image = ["query", "wall.pcd", "box.obj", "--translate=0,0,2", "--sensor=kinect", "--json"];
    let image = inputs.run(&image).quiet(0).json_lines().remove(0);
    assert_eq!(image["undecided_by"], "unseen");
    let options = ["--margin=0.01", "--pose-std=0.01,0,0,0,0,0", "--gradient", "--penetration=0.1"];
    let with = ask(0.07, &options);
    let optional = ["margin", "pose_uncertainty", "gradient", "penetration"];
    assert!(optional.iter().all(|key| with.get(key).is_some()), "{with}");
    // With --margin a clearance has more.
    let with = json!({
        "margin": with["margin"], "pose_uncertainty": with["pose_uncertainty"],
        "gradient": with["gradient"], "penetration": with["penetration"],
    });
    let mut full = ask(0.1, &[]);
    full.as_object_mut().unwrap().extend(with.as_object().unwrap().clone());
    check("query and batch", &[full, image]);
}

#[test]
fn keys_of_a_path_are_documented() {
    let inputs = Inputs::new();
    let run = |heights: [f64; 2]| {
        let line = |z: f64| format!("0.01,0.02,{z},1,0,0,0\n");
        inputs
            .write("poses.csv", &("x,y,z,qw,qx,qy,qz\n".to_owned() + &heights.map(line).concat()));
        let arguments =
            ["path", "floor.pcd", "box.obj", "--sensor=iso:0.002", "--poses=poses.csv", "--json"];
        inputs.run(&arguments).quiet(0).json_lines().remove(0)
    };
    // The second is so far away that it cannot be meant.
    check("path", &[run([0.5, -0.5]), run([0.5, 900.0])]);
}

#[test]
fn keys_of_a_scene_and_of_a_robot_are_documented() {
    let inputs = Inputs::new();
    let scene = |x: f64, sensor: &str| {
        let pose = json!([[1, 0, 0, x], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]);
        let bodies = json!({"format": 1, "length_unit": "m", "bodies": [
            {"name": "floor", "file": "floor.pcd", "sensor": sensor},
            {"name": "box", "file": "box.obj", "pose": pose},
        ]});
        inputs.write("scene.json", &bodies.to_string());
        inputs.run(&["scene", "scene.json", "--json"]).quiet(0).json_lines().remove(0)
    };
    // Far away, and of a camera without rows and columns.
    let (scene, far) = (scene(0.0, "iso:0.002"), scene(30.0, "kinect"));
    let urdf = "<robot name='arm'><link name='post'/><link name='bar'><collision>
        <origin xyz='0.3 0 0'/><geometry><box size='0.6 0.1 0.1'/></geometry></collision></link>
        <joint name='shoulder' type='revolute'><parent link='post'/><child link='bar'/>
        <origin xyz='-0.3 0 0.3'/><axis xyz='0 1 0'/>
        <limit lower='-1' upper='1' effort='1' velocity='1'/></joint></robot>";
    inputs.write("arm.urdf", urdf);
    let robot = |joints: Value| {
        inputs.write("joints.json", &joints.to_string());
        let arguments = ["robot", "floor.pcd", "arm.urdf", "--joints=joints.json", "--json"];
        inputs.run(&arguments).quiet(0).json_lines().remove(0)
    };
    let mut one = robot(json!({"shoulder": 0.6}));
    assert_eq!(one["verdict"], "in_collision");
    // What is told of one position beside its scene.
    for key in ["unchecked_links", "may_touch", "self_filter", "self_collision"] {
        assert!(one.as_object_mut().unwrap().remove(key).is_some(), "{key}: {one}");
    }
    check("scene", &[scene, far, one]);
    let path = robot(json!([{"shoulder": 0.6}, {"shoulder": 0.0}]));
    let of_scene: BTreeSet<String> = documented("scene").into_iter().map(|row| row.key).collect();
    assert_eq!(keys(&path["given"][0]), of_scene);
    let pairs = documented("scene").into_iter().find(|row| row.key == "pairs").unwrap();
    assert_eq!(Some(keys(&path["stopped"]["pair"])), pairs.inner);
    check("robot", &[path, robot(json!([{"shoulder": 0.0}, {"shoulder": 0.1}]))]);
}

/// Programs in Rust had to serialise a warning, or to match every kind, to know the name that JSON has for it.
#[test]
fn the_library_tells_the_codes_of_warnings_as_json_does() {
    let far = Warning::FarAway { gap_m: 9.0, size_m: 1.0 };
    let layout = Warning::SensorLayout { body: Which::A };
    for (warning, code, values) in [
        (far, "far_away", r#"{"gap_m":9.0,"size_m":1.0}"#),
        (layout, "sensor_layout", r#"{"body":"scene"}"#),
    ] {
        assert_eq!(warning.code(), code);
        let words = serde_json::to_string(&warning.to_string()).unwrap();
        let wanted = format!(r#"{{"code":"{code}","values":{values},"words":{words}}}"#);
        assert_eq!(serde_json::to_string(&warning).unwrap(), wanted);
    }
}
