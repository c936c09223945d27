//! `--html` of `scene` and `robot`: all bodies where they stand, and each pair that may touch.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use crate::support::browser::{chromium, open};
use crate::support::pages::{data, page};
use crate::support::{Inputs, Run};
use serde_json::{Value, json};

/// A body at a height, away from the rows of the floor.
fn body(name: &str, file: &str, height: f64) -> Value {
    let pose = json!([[1, 0, 0, 0.01], [0, 1, 0, 0.02], [0, 0, 1, height], [0, 0, 0, 1]]);
    json!({"name": name, "file": file, "pose": pose})
}

/// A box at the floor, and one above it, in a scene 100 m up.
fn scene(inputs: &Inputs, height: f64) -> (Value, String) {
    let mut floor = body("floor", "floor.pcd", 100.0);
    floor["sensor"] = json!("iso:0.002");
    let bodies = [body("box", "box.obj", 100.0 + height), floor, body("bird", "box.obj", 105.0)];
    let file = json!({"format": 1, "length_unit": "m", "bodies": bodies});
    inputs.write("scene.json", &file.to_string());
    let run = inputs.run(&["scene", "scene.json", "--html=o.html", "--force", "--json"]).quiet(0);
    (run.json_lines().remove(0), page(inputs, "o.html"))
}

/// The names of the bodies at these places of a list, and how high each stands.
fn standing<'a>(data: &'a Value, list: &Value) -> Vec<(&'a str, f64)> {
    let of = |placed: &Value| {
        let body = placed["body"].as_u64().unwrap() as usize;
        (data["bodies"][body]["name"].as_str().unwrap(), placed["pose"][11].as_f64().unwrap())
    };
    list.as_array().unwrap().iter().map(of).collect()
}

#[test]
fn the_page_of_a_scene_shows_every_body_and_the_pair_that_collides() {
    let inputs = Inputs::new();
    let (answer, page) = scene(&inputs, 0.09);
    let data = data(&page);
    assert_eq!([&data["is_one_scene"], &data["start"]], [&json!(true), &json!(1)]);
    let all = standing(&data, &data["views"][0]["around"]);
    assert_eq!(all, [("floor", 100.0), ("bird", 105.0), ("box", 100.09)]);
    assert_eq!(data["views"][0]["asked"], Value::Null);
    let pair = &data["views"][1];
    assert_eq!(pair["name"], "floor / box");
    assert_eq!(standing(&data, &pair["around"]), [("bird", 105.0)]);
    let asked = &pair["asked"];
    let two = json!([asked["scene"], asked["object"]]);
    assert_eq!(standing(&data, &two), [("floor", 100.0), ("box", 100.09)]);
    assert_eq!(asked["probability"], answer["pairs"][0]["collision_probability"]);
    // Contacts are in the frame of the scene, as the bodies are.
    let contact = asked["contacts"][0]["point"][2].as_f64().unwrap();
    assert!((contact - 100.0).abs() < 0.05, "{contact}");
    // The picture does not move from one view to the other.
    assert_eq!(data["views"][0]["middle"], pair["middle"]);
    for part in
        ["All in all: in collision", "1 of 3 pairs", "floor</dt><dd>cloud of ", "others</span>"]
    {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn a_free_scene_is_shown_without_a_probability() {
    let inputs = Inputs::new();
    let (_, page) = scene(&inputs, 2.0);
    let data = data(&page);
    assert_eq!(data["views"].as_array().unwrap().len(), 1);
    assert_eq!([&data["start"], &data["views"][0]["asked"]], [&json!(0), &Value::Null]);
    assert!(page.contains("All in all: free") && !page.contains("class=\"verdict"));
}

const URDF: &str = "<robot name='arm'>
  <link name='post'/>
  <link name='arm'><collision><origin xyz='0.5 0 0'/><geometry><box size='1 0.1 0.1'/></geometry></collision></link>
  <joint name='shoulder' type='revolute'><parent link='post'/><child link='arm'/><origin xyz='-0.5 0 0.5'/>
    <axis xyz='0 1 0'/><limit lower='-1.5' upper='1.5' effort='1' velocity='1'/></joint>
</robot>";

fn robot(inputs: &Inputs, joints: &Value) -> Run {
    inputs.write("arm.urdf", URDF);
    inputs.write("joints.json", &joints.to_string());
    let files = ["robot", "floor.pcd", "arm.urdf", "--joints=joints.json", "--sensor=iso:0.002"];
    inputs.run(&[&files[..], &["--html=o.html", "--force", "--json"]].concat()).quiet(0)
}

#[test]
fn the_page_of_a_robot_shows_its_links_in_the_scan() {
    let inputs = Inputs::new();
    let answer = robot(&inputs, &json!({"shoulder": 0.7})).json_lines().remove(0);
    assert_eq!(answer["verdict"], "in_collision");
    let page = page(&inputs, "o.html");
    let data = data(&page);
    let pair = &data["views"][1]["asked"];
    assert_eq!(data["bodies"][0]["name"], "surroundings");
    assert_eq!(pair["probability"], answer["pairs"][0]["collision_probability"]);
    for part in ["not asked: give --self-collision", "surroundings / arm", "arm.urdf in floor.pcd"]
    {
        assert!(page.contains(part), "{part}");
    }
}

/// Between its positions too, where the path ends to be free.
#[test]
fn the_page_of_a_robots_path_shows_where_it_collides() {
    let inputs = Inputs::new();
    let path = json!([{"shoulder": 0.0}, {"shoulder": 0.7}, {"shoulder": 0.0}]);
    let answer = robot(&inputs, &path).json_lines().remove(0);
    let data = data(&page(&inputs, "o.html"));
    let views = data["views"].as_array().unwrap();
    let names: Vec<&str> = views.iter().map(|view| view["name"].as_str().unwrap()).collect();
    assert_eq!(names.len(), 4, "{names:?}");
    assert_eq!([names[0], names[3]], ["Position 1 of 3: free", "Position 3 of 3: free"]);
    let stopped = answer["stopped"]["t"].as_f64().unwrap();
    let between = format!("Segment 1, t = {stopped:.3}: free for certain no longer");
    assert!(names[1].starts_with(&between), "{names:?}");
    assert_eq!(names[2], "Position 2 of 3: in collision, surroundings / arm");
    assert_eq!(data["start"], 2);
}

/// Nothing asked about is no reason to draw nothing.
#[test]
fn a_scene_is_drawn_in_a_browser_without_a_word_in_the_console() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    scene(&inputs, 0.09);
    for (address, shown, hidden) in [("o.html", 1, 0), ("o.html#1", 0, 1)] {
        let seen = open(&browser, &inputs, address, &["--dump-dom"]);
        assert_eq!(seen.console, Vec::<String>::new());
        assert!(seen.elements.contains(&format!("id=\"answer-{shown}\">")), "{address}");
        assert!(seen.elements.contains(&format!("id=\"answer-{hidden}\" hidden")), "{address}");
        assert!(seen.elements.contains("<canvas"), "{address}");
        assert!(seen.elements.contains("view 2 of 2") == (shown == 1), "{address}");
    }
}

#[test]
fn an_input_is_never_replaced_by_a_page() {
    let inputs = Inputs::new();
    scene(&inputs, 1.0);
    for arguments in [
        vec!["scene", "scene.json", "--html=scene.json"],
        vec!["scene", "scene.json", "--html=box.obj"],
        vec!["robot", "floor.pcd", "arm.urdf", "--joints=j.json", "--html=floor.pcd"],
    ] {
        let run = inputs.run(&arguments);
        assert!(run.code() != 0 && run.stderr().contains("is an input"), "{}", run.stderr());
    }
    let again = inputs.run(&["scene", "scene.json", "--html=o.html"]);
    assert!(again.code() != 0 && again.stderr().contains("--force"), "{}", again.stderr());
}
