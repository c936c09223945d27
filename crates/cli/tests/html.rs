//! `--html`: a page that needs nothing else, says what the answer says, and draws the points that were asked about.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::collections::BTreeSet;

use crate::support::pages::{data, page};
use crate::support::{HEIGHTS, Inputs, case_at, case_file, cube, floor};
use base64::Engine as _;
use cloudtouch::geom::{Point3, PointCloud};
use serde_json::Value;

fn bytes(text: &Value) -> Vec<u8> {
    base64::engine::general_purpose::STANDARD.decode(text.as_str().unwrap()).unwrap()
}

/// The points or corners of a body, m.
fn points(body: &Value) -> Vec<Point3> {
    let floats: Vec<f64> = bytes(&body["positions"])
        .chunks_exact(4)
        .map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap())))
        .collect();
    let middle: [f64; 3] = serde_json::from_value(body["middle"].clone()).unwrap();
    floats
        .chunks_exact(3)
        .map(|p| Point3::new(p[0], p[1], p[2]) + Point3::from(middle).coords)
        .collect()
}

/// None of them fetches anything.
const TAGS: [&str; 31] = [
    "!DOCTYPE", "html", "head", "meta", "title", "style", "body", "main", "div", "noscript", "p",
    "aside", "h1", "h2", "h3", "section", "dl", "dt", "dd", "span", "b", "i", "table", "thead",
    "tbody", "tr", "th", "td", "details", "summary", "pre",
];

/// Nothing in a page makes a browser ask for another file.
fn check_alone(page: &str) {
    let (head, _) = page.split_once("<script type").unwrap();
    assert!(head.starts_with("<!DOCTYPE html>\n") && page.ends_with("</html>\n"));
    assert!(head.contains("content=\"default-src 'none'; script-src 'unsafe-inline'; style-src"));
    let name = |rest: &str| {
        rest.trim_start_matches('/').split([' ', '>', '\n']).next().unwrap().to_owned()
    };
    let tags: BTreeSet<String> = head.split('<').skip(1).map(name).collect();
    let unknown: Vec<&String> = tags.iter().filter(|tag| !TAGS.contains(&tag.as_str())).collect();
    assert!(unknown.is_empty(), "{unknown:?}");
    let (style, _) = head.split_once("</style>").unwrap();
    assert!(!style.contains("@import") && !style.contains("url("));
    assert_eq!(page.matches("<script").count(), 2);
    assert_eq!(page.matches("</script").count(), 2);
    assert!(page.contains("Permission is hereby granted"), "the licence of three.js goes along");
}

#[test]
fn the_page_of_a_query_says_what_the_answer_says() {
    let inputs = Inputs::new();
    for (verdict, _, height) in HEIGHTS {
        let name = format!("{verdict}.html");
        let run = inputs.query_at(height, &["--json", "--html", &name]).quiet(0);
        let answer = &run.json_lines()[0];
        assert_eq!(answer["verdict"], verdict);
        let page = page(&inputs, &name);
        check_alone(&page);
        let words = verdict.replace('_', " ");
        assert!(page.contains(&format!("</span> {words} <b>")), "{verdict}");
        assert!(page.contains("<title>box.obj in floor.pcd</title>"));
        let view = &data(&page)["views"][0]["asked"];
        assert_eq!(view["probability"], answer["collision_probability"]);
        assert_eq!(view["bounds"], answer["bounds"]);
        let rows: Vec<Value> = answer["pose"]
            .as_array()
            .unwrap()
            .iter()
            .flat_map(|r| r.as_array().unwrap().clone())
            .collect();
        assert_eq!(view["object"]["pose"], Value::from(rows));
        let drawn = view["contacts"].as_array().unwrap();
        let contacts = answer["contacts"].as_array().unwrap();
        assert_eq!(drawn.len(), contacts.len());
        for (drawn, contact) in drawn.iter().zip(contacts) {
            assert_eq!(drawn["point"], contact["point"]);
            assert_eq!(drawn["normal"], contact["normal_a_to_b"]);
        }
    }
}

#[test]
fn what_is_drawn_are_the_points_and_corners_of_the_files() {
    let inputs = Inputs::new();
    // Map coordinates, which single precision alone would round to half a metre.
    let far = Point3::new(4_000_000.0, 500_000.0, 300.0);
    let shifted = floor().points.iter().map(|p| p + far.coords).collect();
    cloudtouch_io::write_cloud_pcd(inputs.path("far.pcd"), &PointCloud::from_points(shifted))
        .unwrap();
    let translate = "--translate=4000000,500000,300.05";
    let arguments =
        ["query", "far.pcd", "box.obj", "--sensor=iso:0.002", translate, "--html=o.html"];
    inputs.run(&arguments).quiet(0);
    let data = data(&page(&inputs, "o.html"));
    let near = |a: &Point3, b: &Point3| (a - b).norm() < 1e-6;
    let drawn = points(&data["bodies"][0]);
    let expected: Vec<Point3> = floor().points.iter().map(|p| p + far.coords).collect();
    assert_eq!(drawn.len(), expected.len());
    assert!(drawn.iter().zip(&expected).all(|(a, b)| near(a, b)));
    let corners = points(&data["bodies"][1]);
    assert_eq!(corners.len(), 8);
    assert!(cube(0.1).vertices().iter().all(|v| corners.iter().any(|c| near(c, v))));
    assert_eq!(bytes(&data["bodies"][1]["triangles"]).len(), 12 * 3 * 4);
    // Points that are coloured lie under the box.
    let likely = bytes(&data["views"][0]["asked"]["likely"][0]["points"]);
    let likely: BTreeSet<u32> =
        likely.chunks_exact(4).map(|b| u32::from_le_bytes(b.try_into().unwrap())).collect();
    assert!(!likely.is_empty());
    for index in likely {
        let p = drawn[index as usize] - far.coords;
        assert!(p.x.abs() < 0.25 && p.y.abs() < 0.25, "{p}");
    }
}

#[test]
fn names_that_are_html_stay_names() {
    let inputs = Inputs::new();
    let hostile = "<img src=x onerror=alert(1)>&\"'.obj";
    std::fs::copy(inputs.path("box.obj"), inputs.path(hostile)).unwrap();
    let arguments = ["query", "floor.pcd", hostile, "--translate=0,0,0.05", "--html=o.html"];
    inputs.run(&arguments).quiet(0);
    let text = page(&inputs, "o.html");
    check_alone(&text);
    assert!(!text.contains("<img"));
    assert_eq!(data(&text)["bodies"][1]["name"], hostile);
    let id = "</script><script>alert(1)</script>";
    inputs.write("cases.json", &case_file(&[case_at(id, 0.05), case_at("second", 0.5)]));
    inputs.run(&["batch", "cases.json", "--html=b.html"]).quiet(0);
    let text = page(&inputs, "b.html");
    check_alone(&text);
    assert_eq!(data(&text)["views"][0]["name"], id);
}

#[test]
fn two_meshes_have_a_page_too() {
    let inputs = Inputs::new();
    inputs.run(&["query", "box.obj", "box.obj", "--translate=0.15,0,0", "--html=o.html"]).quiet(0);
    let text = page(&inputs, "o.html");
    check_alone(&text);
    assert!(text.contains("</span> in collision <b>1.000</b>"));
    assert!(data(&text)["bodies"][0]["triangles"].is_string());
}

#[test]
fn a_batch_has_a_view_a_case_and_names_those_without_an_answer() {
    let inputs = Inputs::new();
    let cases: Vec<String> =
        HEIGHTS.iter().map(|(verdict, _, height)| case_at(verdict, *height)).collect();
    let missing = case_at("lost", 0.1).replace("box.obj", "no.obj");
    inputs.write("cases.json", &case_file(&[&cases[..], &[missing]].concat()));
    let run = inputs.run(&["batch", "cases.json", "--html=o.html", "--json"]);
    assert_eq!(run.code(), 1);
    let text = page(&inputs, "o.html");
    check_alone(&text);
    assert!(text.contains("<dt>No answer: lost</dt><dd>"));
    let data = data(&text);
    // One scene and one object, however many poses.
    assert_eq!(data["bodies"].as_array().unwrap().len(), 2);
    let views = data["views"].as_array().unwrap();
    for (view, answer) in views.iter().zip(run.json_lines()) {
        assert_eq!(view["name"], answer["id"]);
        assert_eq!(view["asked"]["probability"], answer["collision_probability"]);
    }
    assert_eq!(views.len(), 3);
    assert_eq!(text.matches("<section class=\"answer\"").count(), 3);
}

#[test]
fn a_path_shows_its_poses_and_where_it_first_collides() {
    let inputs = Inputs::new();
    inputs.write(
        "path.csv",
        "x,y,z,qw,qx,qy,qz\n0,0,0.5,1,0,0,0\n0,0,0.3,1,0,0,0\n0,0,0.05,1,0,0,0\n",
    );
    let arguments = [
        "path",
        "floor.pcd",
        "box.obj",
        "--poses=path.csv",
        "--sensor=iso:0.002",
        "--json",
        "--html=o.html",
    ];
    let answer = &inputs.run(&arguments).quiet(0).json_lines()[0];
    let text = page(&inputs, "o.html");
    check_alone(&text);
    assert!(text.contains("<dt>Verdict on the whole path</dt><dd>in collision</dd>"));
    let data = data(&text);
    let views = data["views"].as_array().unwrap();
    let start = &views[data["start"].as_u64().unwrap() as usize];
    assert_eq!(start["asked"]["probability"], answer["first"]["probability"]);
    let likeliest = |view: &&Value| view["asked"]["probability"] == answer["max_probability"];
    assert!(views.iter().any(|view| likeliest(&view)));
    let heights: Vec<f64> =
        views.iter().map(|view| view["asked"]["object"]["pose"][11].as_f64().unwrap()).collect();
    assert!(heights.is_sorted_by(|a, b| a > b), "{heights:?}");
    for given in [0.5, 0.3, 0.05] {
        assert!(heights.iter().any(|z| (z - given).abs() < 1e-9), "{given}");
    }
    let first = answer["first"]["pose"][2][3].as_f64().unwrap();
    let is_first =
        |view: &&Value| view["name"].as_str().unwrap().contains("in collision from here");
    let shown: Vec<&Value> = views.iter().filter(is_first).collect();
    assert_eq!(shown.len(), 1);
    assert_eq!(shown[0]["asked"]["object"]["pose"][11].as_f64().unwrap(), first);
}

#[test]
fn a_page_names_the_option_that_a_warning_asks_for() {
    let inputs = Inputs::new();
    let query = ["query", "floor.pcd", "box.obj", "--unit=mm", "--translate=0,0,0.005"];
    inputs.run(&[&query[..], &["--html=o.html"]].concat()).quiet(0);
    let text = page(&inputs, "o.html");
    assert!(
        text.contains("is a file in millimetres? (--cloud-unit mm, --unit mm, --depth-scale)</p>"),
        "{text}"
    );
}

#[test]
fn no_input_is_replaced_and_another_file_only_with_force() {
    let inputs = Inputs::new();
    let refused = inputs.query_at(0.5, &["--html", "box.obj", "--force"]);
    assert_eq!(refused.code(), 1);
    assert!(refused.stderr().contains("is an input"), "{}", refused.stderr());
    inputs.write("o.html", "mine");
    let refused = inputs.query_at(0.5, &["--html", "o.html"]);
    assert!(refused.code() == 1 && refused.stderr().contains("--force"), "{}", refused.stderr());
    assert_eq!(page(&inputs, "o.html"), "mine");
    inputs.query_at(0.5, &["--html", "o.html", "--force"]).quiet(0);
    assert!(page(&inputs, "o.html").starts_with("<!DOCTYPE"));
    // Files of options are inputs too, and no output is another's.
    inputs.write("pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0.5\n0 0 0 1\n");
    inputs.write("set.toml", "");
    std::fs::create_dir(inputs.path("in")).unwrap();
    let query = ["query", "floor.pcd", "box.obj", "--force"];
    for (more, part) in [
        (["--pose=pose.txt", "--html=pose.txt", "--max-unseen=1"], "is an input"),
        (["--mode=paper", "--settings=set.toml", "--csv=set.toml"], "is an input"),
        (["--ply=both", "--html=./both", "--max-unseen=1"], "is to be written twice"),
        // By another way: the second took the place of the first, without a word.
        (["--ply=both", "--html=in/../both", "--max-unseen=1"], "is to be written twice"),
    ] {
        let refused = inputs.run(&[&query[..], &more].concat());
        assert!(refused.stderr().contains(part), "{more:?}: {}", refused.stderr());
    }
    assert!(!inputs.path("both").exists() && page(&inputs, "set.toml").is_empty());
    inputs.write("path.csv", "x,y,z,qw,qx,qy,qz\n0,0,0.5,1,0,0,0\n0,0,0.3,1,0,0,0\n");
    let path = ["path", "floor.pcd", "box.obj", "--poses=path.csv", "--html=path.csv", "--force"];
    assert!(inputs.run(&path).stderr().contains("is an input"));
    inputs.write("cases.json", &case_file(&[case_at("a", 0.5)]));
    std::fs::copy(inputs.path("box.obj"), inputs.path("arm.obj")).unwrap();
    for input in ["cases.json", "floor.pcd", "arm.obj"] {
        let output = format!("--html={input}");
        let batch = ["batch", "cases.json", "--robot=arm.obj", &output, "--force"];
        assert!(inputs.run(&batch).stderr().contains("is an input"), "{input}");
    }
}

#[test]
fn the_same_question_gives_the_same_bytes_with_one_thread_and_many() {
    let inputs = Inputs::new();
    let cases: Vec<String> =
        (0..20).map(|i| case_at(&format!("c{i}"), 0.02 * f64::from(i))).collect();
    inputs.write("cases.json", &case_file(&cases));
    let run = |threads: &str, name: &str| {
        let mut command = assert_cmd::Command::cargo_bin("cloudtouch").unwrap();
        let arguments = ["batch", "cases.json", "--html", name];
        command.current_dir(inputs.path("")).env("RAYON_NUM_THREADS", threads).args(arguments);
        command.assert().success();
        page(&inputs, name)
    };
    assert!(run("1", "a.html") == run("4", "b.html"));
}

#[test]
fn a_large_scan_is_thinned_below_twelve_megabytes_and_says_so() {
    let inputs = Inputs::new();
    let side = 700_u32;
    let points = (0..side * side)
        .map(|i| (f64::from(i % side), f64::from(i / side)))
        .map(|(i, j)| Point3::new(0.002 * i - 0.7, 0.002 * j - 0.7, 1e-4 * ((i * j) % 7.0)));
    let large = PointCloud::from_points(points.collect());
    cloudtouch_io::write_cloud_pcd(inputs.path("large.pcd"), &large).unwrap();
    let arguments = ["query", "large.pcd", "box.obj", "--sensor=iso:0.002", "--translate=0,0,0.1"];
    let output = ["--html=o.html", "--json", "--points"];
    let answer = &inputs.run(&[&arguments[..], &output].concat()).quiet(0).json_lines()[0];
    let text = page(&inputs, "o.html");
    assert!(text.len() < 12_000_000, "{} bytes", text.len());
    assert!(text.contains("large.pcd: 300000 of 490000 points are drawn"));
    let data = data(&text);
    assert_eq!(bytes(&data["bodies"][0]["positions"]).len(), 12 * 300_000);
    // None of those that matter is left out.
    let told = answer["points"]["a"].as_array().unwrap();
    let told = told.iter().filter(|pair| pair[1].as_f64().unwrap() >= 0.01).count();
    assert!(told > 0);
    assert_eq!(bytes(&data["views"][0]["asked"]["likely"][0]["points"]).len(), 4 * told);
}

/// In the page of a batch, points that are deep in a box were as grey as any.
#[test]
fn a_batch_drew_no_points_inside_of_a_box() {
    let inputs = Inputs::new();
    inputs.query_at(0.02, &["--html=q.html"]).quiet(0);
    inputs.write("cases.json", &case_file(&[case_at("deep", 0.02)]));
    inputs.run(&["batch", "cases.json", "--html=b.html"]).quiet(0);
    let [one, many] = ["q.html", "b.html"].map(|name| data(&page(&inputs, name)));
    let likely = &one["views"][0]["asked"]["likely"];
    assert!(bytes(&likely[0]["points"]).len() > 5 * 4, "{likely}");
    assert_eq!(&many["views"][0]["asked"]["likely"], likely);
}

/// The answer in the terminal said so, and the page that was sent around did not.
#[test]
fn a_page_says_that_what_was_not_seen_is_unknown() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &case_file(&[case_at("a", 0.5)]));
    inputs.query_at(0.5, &["--html=query.html"]).quiet(0);
    inputs.run(&["batch", "cases.json", "--html=batch.html"]).quiet(0);
    inputs.run(&["query", "box.obj", "box.obj", "--html=meshes.html"]);
    let told = |name| page(&inputs, name).contains("what the sensor did not see counts as empty");
    assert_eq!(["query.html", "batch.html", "meshes.html"].map(told), [true, true, false]);
}
