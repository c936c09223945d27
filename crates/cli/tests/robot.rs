//! `cloudtouch robot`: a post with an arm that turns, over the floor.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::{Inputs, Run};
use serde_json::{Value, json};

/// An arm of a metre, 10 cm thick, on a shoulder 0.5 m over the floor that bends it down.
const URDF: &str = "<robot name='arm'>
  <link name='post'><visual><geometry><box size='1 1 1'/></geometry></visual></link>
  <link name='arm'><collision><origin xyz='0.5 0 0'/><geometry><mesh filename='package://mine/bar.obj'/>
    </geometry></collision></link>
  <joint name='shoulder' type='revolute'><parent link='post'/><child link='arm'/><origin xyz='-0.5 0 0.5'/>
    <axis xyz='0 1 0'/><limit lower='-1.5' upper='1.5' effort='1' velocity='1'/></joint>
</robot>";

fn inputs() -> Inputs {
    let inputs = Inputs::new();
    inputs.write("arm.urdf", URDF);
    std::fs::create_dir(inputs.path("parts")).unwrap();
    let bar: String = (0..8)
        .map(|i| {
            let sign = |axis: usize| if i >> axis & 1 == 1 { 1.0 } else { -1.0 };
            format!("v {} {} {}\n", 0.5 * sign(0), 0.05 * sign(1), 0.05 * sign(2))
        })
        .collect();
    let faces = "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
    inputs.write("parts/bar.obj", &(bar + faces));
    inputs
}

fn robot(inputs: &Inputs, joints: &Value, more: &[&str]) -> Run {
    inputs.write("joints.json", &joints.to_string());
    let arguments = [
        "robot",
        "floor.pcd",
        "arm.urdf",
        "--joints=joints.json",
        "--package=mine=parts",
        "--sensor=iso:0.002",
    ];
    inputs.run(&[&arguments, more].concat())
}

/// A base that is bolted to what was scanned touches it at any positions.
#[test]
fn a_link_may_touch_the_scan() {
    let inputs = inputs();
    let down = json!({"shoulder": 0.7});
    let none = robot(&inputs, &down, &["--may-touch=arm", "--json", "--exit-code"]);
    // There is no other link with a shape: nothing is checked, and it read as free.
    assert!(
        none.code() == 30 && none.stderr().contains("none was asked about"),
        "{}",
        none.stderr()
    );
    let answer = none.json_lines().remove(0);
    assert_eq!([&answer["verdict"], &answer["undecided_by"]], ["undecided", "unchecked"]);
    assert_eq!(answer["may_touch"], json!(["arm"]));
    let path = json!([{"shoulder": 0.7}, {"shoulder": 0.8}]);
    let none = robot(&inputs, &path, &["--may-touch=arm", "--json", "--exit-code"]);
    let answer = none.json_lines().remove(0);
    assert_eq!((none.code(), &answer["certified_free_until"]), (30, &json!(0.0)), "{answer}");
    let text = robot(&inputs, &path, &["--may-touch=arm", "--html=o.html"]).stdout();
    assert!(text.contains("undecided: all pairs may touch"), "{text}");
    let page = std::fs::read_to_string(inputs.path("o.html")).unwrap();
    assert!(page.contains("all pairs may touch"), "free for certain until 0 %, it said");
    let text = robot(&inputs, &down, &["--may-touch", "arm"]).stdout();
    assert!(text.contains("may touch the scan     arm\n"), "{text}");
    let slip = robot(&inputs, &down, &["--may-touch=am"]);
    assert_eq!(slip.code(), 2);
    let slip = slip.stderr();
    assert!(slip.contains("--may-touch am") && slip.contains("post, arm"), "{slip}");
}

/// A pair with a misspelt link was passed over in silence, and so checked.
#[test]
fn a_link_of_the_srdf_that_is_not_there_is_warned_of() {
    let inputs = inputs();
    let srdf = |link: &str| {
        let pair = format!("<disable_collisions link1='post' link2='{link}' reason='Never'/>");
        inputs.write("arm.srdf", &format!("<robot name='arm'>{pair}</robot>"));
        robot(&inputs, &json!({"shoulder": 0.0}), &["--self-collision", "--srdf=arm.srdf"])
    };
    srdf("arm").quiet(0);
    let run = srdf("amr");
    assert_eq!(run.code(), 0);
    let told = run.stderr();
    let part = "arm.srdf: disable_collisions names amr, no link of arm.urdf (post, arm): correct";
    assert!(told.contains(part), "{told}");
}

/// Neither the file was named nor whose name it is.
#[test]
fn a_link_with_the_name_of_the_scan_is_told_with_its_file() {
    let inputs = inputs();
    inputs.write("arm.urdf", &URDF.replace("'arm'", "'surroundings'"));
    let run = robot(&inputs, &json!({"shoulder": 0.0}), &[]);
    let told = run.stderr();
    assert_eq!(run.code(), 1);
    assert!(told.contains("arm.urdf: the scene has a body named `surroundings`"), "{told}");
}

/// It was told that no file is a mesh, with a robot full of them.
#[test]
fn the_unit_of_meshes_is_not_that_of_links() {
    let inputs = inputs();
    let run = robot(&inputs, &json!({"shoulder": 0.0}), &["--unit=mm"]);
    let told = run.stderr();
    assert_eq!(run.code(), 2);
    for part in ["floor.pcd is a cloud", "--cloud-unit", "times the `scale` that the URDF gives"] {
        assert!(told.contains(part), "{told}");
    }
}

/// The lower edge of its end is at the floor where sin + 0.05 cos = 0.5, at 0.47 rad.
#[test]
fn an_arm_that_bends_down_touches_the_floor() {
    let inputs = inputs();
    for (angle, verdict, code) in [(0.0, "free", 0), (0.3, "free", 0), (0.7, "in_collision", 20)] {
        let run =
            robot(&inputs, &json!({"shoulder": angle}), &["--json", "--exit-code"]).quiet(code);
        let answer = run.json_lines().remove(0);
        assert_eq!(answer["verdict"], verdict, "{angle}");
        // Only the text told of what was not asked.
        let asked = ["unchecked_links", "self_filter", "self_collision"].map(|key| &answer[key]);
        assert_eq!(asked, [&json!(["post"]), &json!(false), &json!(false)]);
        let text = robot(&inputs, &json!({"shoulder": angle}), &[]).quiet(0).stdout();
        assert!(text.contains("not checked            post"), "{text}");
        if code == 20 {
            assert_eq!(
                [&answer["pairs"][0]["a"], &answer["pairs"][0]["b"]],
                ["surroundings", "arm"]
            );
            assert!(
                text.contains("worst pair             surroundings / arm: in collision"),
                "{text}"
            );
            assert!(text.contains("contact                "), "{text}");
        }
    }
    // The base lifted by 40 cm, it is above the floor.
    inputs.write("base.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0.4\n0 0 0 1\n");
    let lifted = ["--base-pose=base.txt", "--exit-code"];
    robot(&inputs, &json!({"shoulder": 0.7}), &lifted).quiet(0);
}

#[test]
fn a_path_is_certified_or_ends_where_the_arm_meets_the_floor() {
    let inputs = inputs();
    let free = json!([{"shoulder": -1.0}, {"shoulder": 0.3}]);
    let answer = robot(&inputs, &free, &["--json", "--exit-code"]).quiet(0).json_lines().remove(0);
    assert_eq!(
        (&answer["verdict"], &answer["certified_free_until"]),
        (&json!("free"), &json!(1.0))
    );
    let down = json!([{"shoulder": 0.0}, {"shoulder": 1.0}]);
    let answer = robot(&inputs, &down, &["--json", "--exit-code"]).quiet(20).json_lines().remove(0);
    let until = answer["certified_free_until"].as_f64().unwrap();
    assert!((0.4..0.48).contains(&until), "{until}");
    assert_eq!(answer["given"][1]["verdict"], "in_collision");
    assert_eq!(answer["unchecked_links"], json!(["post"]));
    let text = robot(&inputs, &down, &[]).quiet(0).stdout();
    assert!(
        text.contains("free for certain       until 4") && text.contains("position 2  "),
        "{text}"
    );
}

#[test]
fn the_robot_is_removed_from_its_scan_where_it_was() {
    let inputs = inputs();
    // What a camera saw of the arm at zero, beside the floor.
    let mut rows: String = (0..441)
        .map(|i| {
            format!("{} {} 0\n", 0.05 * f64::from(i % 21) - 0.5, 0.05 * f64::from(i / 21) - 0.5)
        })
        .collect();
    rows.extend((0..40).map(|i| format!("{} 0.004 0.54\n", -0.4 + 0.02 * f64::from(i))));
    inputs.write("seen.xyz", &rows);
    inputs.write("zero.json", "{\"shoulder\": 0.0}");
    let ask = |more: &[&str]| {
        let arguments = [
            "robot",
            "seen.xyz",
            "arm.urdf",
            "--joints=zero.json",
            "--package=mine=parts",
            "--sensor=iso:0.002",
            "--exit-code",
        ];
        inputs.run(&[&arguments, more].concat())
    };
    assert_ne!(ask(&[]).code(), 0);
    ask(&["--scan-joints=zero.json"]).quiet(0);
    inputs.write("up.json", "{\"shoulder\": -1.5}");
    let elsewhere = ask(&["--scan-joints=up.json"]).stdout();
    assert!(
        elsewhere.contains("surroundings: no point of the scene lies on the robot"),
        "{elsewhere}"
    );
    assert!(elsewhere.contains("where                  robot in ("), "{elsewhere}");
}

#[test]
fn wrong_use_is_refused_with_the_remedy() {
    let inputs = inputs();
    let home = json!({"shoulder": 0.0});
    for (joints, more, code, parts) in [
        (json!({}), vec![], 1, vec!["joints.json", "`shoulder`", "every joint"]),
        (json!({"shoulder": 2.0}), vec![], 1, vec!["`shoulder`", "beyond its limits -1.5 .. 1.5"]),
        (json!({"shoulder": 0, "elbow": 0}), vec![], 1, vec!["`elbow`", "`shoulder`"]),
        (json!([home]), vec![], 1, vec!["too few positions (1)"]),
        (
            json!([home, {"shoulder": 2.0}]),
            vec![],
            1,
            vec!["joints.json: position 2 of the list: joint `shoulder`", "beyond its limits"],
        ),
        (home.clone(), vec!["--mode=paper"], 2, vec!["leave --mode out"]),
        (home.clone(), vec!["--package=mine"], 2, vec!["NAME=FOLDER"]),
        (
            home.clone(),
            vec!["--package=mime=parts"],
            2,
            vec!["--package mime=parts", "arm.urdf", "one of mine"],
        ),
        (home.clone(), vec!["--srdf=arm.srdf"], 2, vec!["--self-collision"]),
        (home.clone(), vec!["--robot=box.obj"], 2, vec!["--scan-joints"]),
        (
            home.clone(),
            vec!["--self-collision", "--srdf=gone.srdf"],
            1,
            vec!["gone.srdf", "cannot be read"],
        ),
        (home.clone(), vec!["--base-pose=gone.txt"], 1, vec!["gone.txt"]),
    ] {
        let run = robot(&inputs, &joints, &more);
        assert_eq!(run.code(), code, "{}", run.stderr());
        assert!(parts.iter().all(|part| run.stderr().contains(part)), "{}", run.stderr());
    }
    std::fs::remove_file(inputs.path("parts/bar.obj")).unwrap();
    let error = robot(&inputs, &home, &[]).stderr();
    assert!(
        error.contains("arm.urdf: link `arm`: package://mine/bar.obj: there is no file"),
        "{error}"
    );
}

/// Millimetres read as metres: the arm was 400 m away, free, and nothing said so.
#[test]
fn a_robot_far_from_its_scan_was_free_without_a_word() {
    let inputs = inputs();
    for (x, is_told) in [("0.2", false), ("400", true)] {
        inputs.write("base.txt", &format!("1 0 0 {x}\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"));
        for joints in [json!({"shoulder": 0.1}), json!([{"shoulder": 0.1}, {"shoulder": 0.2}])] {
            let run = robot(&inputs, &joints, &["--base-pose=base.txt", "--json"]);
            assert_eq!(run.code(), 0, "{}", run.stderr());
            let text = robot(&inputs, &joints, &["--base-pose=base.txt"]).quiet(0).stdout();
            assert_eq!(text.contains("warning                `arm` is 39"), is_told, "{text}");
            let answer = run.json_lines().remove(0);
            let outside = answer.pointer("/given/0/outside").unwrap_or(&answer["outside"]);
            let names = outside.as_array().unwrap().iter().map(|of| of["name"].as_str().unwrap());
            assert_eq!(names.collect::<Vec<_>>().contains(&"arm"), is_told, "{outside}");
        }
    }
}
