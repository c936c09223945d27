//! `cloudtouch robot --held`: what the robot holds moves with its link and is asked about.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::pages::{data, page};
use crate::support::{Inputs, Run};
use serde_json::{Value, json};

/// A hand without a body of its own on an arm that turns 45 cm over the floor.
const URDF: &str = "<robot name='arm'>
  <link name='post'/>
  <link name='arm'><collision><geometry><box size='0.1 0.1 0.1'/></geometry></collision></link>
  <link name='hand'/>
  <joint name='shoulder' type='revolute'><parent link='post'/><child link='arm'/><origin xyz='0 0 0.45'/>
    <axis xyz='0 1 0'/><limit lower='-2' upper='2' effort='1' velocity='1'/></joint>
  <joint name='wrist' type='fixed'><parent link='arm'/><child link='hand'/><origin xyz='0.3 0 0'/></joint>
</robot>";

/// A cube of 20 cm in the hand: bent down by 1.4 rad, the arm takes it 6 cm through the floor.
fn held() -> Value {
    let pose = json!([[1, 0, 0, 0.1], [0, 1, 0, 0.0], [0, 0, 1, 0.0], [0, 0, 0, 1]]);
    json!({"format": 1, "length_unit": "m",
        "bodies": [{"name": "parcel", "file": "box.obj", "attached_to": "hand", "pose": pose}]})
}

fn robot(inputs: &Inputs, held: &Value, angle: f64, more: &[&str]) -> Run {
    inputs.write("arm.urdf", URDF);
    inputs.write("held.json", &held.to_string());
    inputs.write("joints.json", &json!({"shoulder": angle}).to_string());
    let files = ["robot", "floor.pcd", "arm.urdf", "--joints=joints.json", "--sensor=iso:0.002"];
    inputs.run(&[&files[..], &["--held=held.json"], more].concat())
}

#[test]
fn what_is_held_collides_where_the_link_takes_it() {
    let inputs = Inputs::new();
    let up =
        robot(&inputs, &held(), 0.0, &["--json", "--exit-code"]).quiet(0).json_lines().remove(0);
    assert_eq!(up["bodies"]["parcel"]["unit"], "m");
    assert_eq!(up["boxes"]["parcel"][0][2].as_f64().map(|z| (1e3 * z).round()), Some(350.0));
    let down = robot(&inputs, &held(), 1.4, &["--json", "--exit-code"]).quiet(20);
    let down = down.json_lines().remove(0);
    let pairs = down["pairs"].as_array().unwrap();
    assert_eq!(pairs.len(), 1);
    assert_eq!([&pairs[0]["a"], &pairs[0]["b"]], [&json!("surroundings"), &json!("parcel")]);
    let text = robot(&inputs, &held(), 1.4, &[]).quiet(0).stdout();
    assert!(text.contains("parcel: watertight mesh of 12 triangles"), "{text}");
    assert!(text.contains("attached to hand") && text.contains("surroundings / parcel"), "{text}");
}

#[test]
fn it_goes_along_a_path_and_on_the_page() {
    let inputs = Inputs::new();
    let path = json!([{"shoulder": 0.0}, {"shoulder": 1.4}]);
    robot(&inputs, &held(), 0.0, &[]).quiet(0);
    inputs.write("path.json", &path.to_string());
    let files = ["robot", "floor.pcd", "arm.urdf", "--joints=path.json", "--sensor=iso:0.002"];
    let run = inputs.run(&[&files[..], &["--held=held.json", "--json", "--html=o.html"]].concat());
    let answer = run.quiet(0).json_lines().remove(0);
    let until = answer["certified_free_until"].as_f64().unwrap();
    assert!((0.3..0.9).contains(&until), "{until}");
    let page = page(&inputs, "o.html");
    assert!(page.contains("parcel") && data(&page)["bodies"].as_array().unwrap().len() == 3);
}

#[test]
fn what_may_touch_is_not_asked_about() {
    let inputs = Inputs::new();
    let mut file = held();
    file["allowed"] = json!([["parcel", "surroundings"]]);
    robot(&inputs, &file, 1.4, &["--exit-code"]).quiet(0);
}

#[test]
fn slips_in_the_file_are_told_with_place_and_remedy() {
    let inputs = Inputs::new();
    let with = |key: &str, value: Value| {
        let mut file = held();
        file["bodies"][0][key] = value;
        file
    };
    let mut threshold = held();
    threshold["threshold"] = json!(0.2);
    let mut allowed = held();
    allowed["allowed"] = json!([["parcel", "hind"]]);
    let none = json!({"format": 1, "length_unit": "m", "bodies": []});
    let mut loose = held();
    loose["bodies"][0].as_object_mut().unwrap().remove("attached_to");
    for (file, parts) in [
        (
            with("attached_to", json!("hind")),
            ["body 1 `parcel`", "no link of the robot, of post, arm, hand"],
        ),
        (with("attached_to", Value::Null), ["body 1 `parcel`", "`attached_to` is null"]),
        (loose, ["body 1 `parcel`", "give `attached_to`, the link that holds it"]),
        (with("name", json!("arm")), ["body 1 `arm`", "give the new one another name"]),
        (with("file", json!("gone.obj")), ["body 1 `parcel`", "gone.obj"]),
        (with("sensor", json!("iso:0.002")), ["body 1 `parcel`", "sensor"]),
        (threshold, ["`threshold` is of a scene", "--reject"]),
        (allowed, ["pair 1 of \"allowed\"", "nothing with a shape is named `hind`"]),
        (none, ["no bodies", "leave the file out"]),
    ] {
        let run = robot(&inputs, &file, 0.0, &[]);
        let told = run.stderr();
        assert_eq!(run.code(), 1, "{told}");
        for part in ["held.json"].into_iter().chain(parts) {
            assert!(told.contains(part), "{part}: {told}");
        }
    }
}

/// Units and sensors of what is held were refused, for the scan had no use for them.
#[test]
fn options_tell_of_what_is_held_too() {
    let inputs = Inputs::new();
    let unit = |more: &[&str]| {
        let run = robot(&inputs, &held(), 0.0, &[&["--json"], more].concat()).quiet(0);
        run.json_lines().remove(0)["bodies"]["parcel"]["unit"].clone()
    };
    assert_eq!([unit(&[]), unit(&["--unit=cm"])], ["m", "cm"]);
    let mut own = held();
    own["bodies"][0]["unit"] = json!("m");
    let refused = robot(&inputs, &own, 0.0, &["--unit=cm"]);
    assert!(refused.code() == 2 && refused.stderr().contains("each mesh has one"));
    // A cloud that is held in a scene that is a mesh.
    let mut cloud = held();
    cloud["bodies"][0]["file"] = json!("floor.pcd");
    inputs.write("held.json", &cloud.to_string());
    let files = ["robot", "box.obj", "arm.urdf", "--joints=joints.json", "--held=held.json"];
    let answer = inputs.run(&[&files[..], &["--sensor=iso:0.002", "--json"]].concat()).quiet(0);
    assert_eq!(answer.json_lines()[0]["bodies"]["parcel"]["sensor"], "iso:0.002");
}
