//! Slips of someone in a hurry and bad files, one a line: none reads free, none panics, and each
//! message names the place, the value and what to do.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::{Inputs, case_at, case_file, cube, floor};
use cloudtouch::geom::{Point3, PointCloud, Vector3};
use serde_json::Value;

/// Arguments, and what the answer or the error has to say.
type Slip = (&'static str, &'static [&'static str]);

/// Units, poses and sizes that cannot be meant: an answer that is not free, with a warning.
const DOUBTED: &[Slip] = &[
    (
        "floor_mm.pcd box.obj --translate 0,0,0.5",
        &["verdict\":\"undecided", "1414", "--cloud-unit mm"],
    ),
    ("floor_mm.pcd box.obj --translate 0,0,500", &["verdict\":\"undecided", "--cloud-unit mm"]),
    ("floor.pcd box_mm.obj --translate 0,0,0.5", &["verdict\":\"in_collision", "346", "--unit mm"]),
    ("floor.pcd box_mm.obj --translate 0,0,400", &["verdict\":\"undecided", "346", "--unit mm"]),
    (
        "floor_mm.pcd box_mm.obj --unit mm --translate 0,0,0.5",
        &["verdict\":\"undecided", "--cloud-unit"],
    ),
    (
        "floor.pcd box.obj --unit mm --translate 0,0,0.005",
        &["verdict\":\"undecided", "points of the scene"],
    ),
    (
        "floor.pcd box.obj --translate 10,20,500",
        &["verdict\":\"undecided", "far_away", "check the pose"],
    ),
    ("far.xyz box.obj", &["verdict\":\"undecided", "far_away", "check the pose"]),
    ("floor.pcd box.obj --pose mm.txt", &["verdict\":\"undecided", "far_away", "unit"]),
    (
        "point.xyz box.obj --translate 0,0,2",
        &["verdict\":\"undecided", "points in one place", "check the file"],
    ),
    ("same.xyz box.obj --translate 0,0,2", &["verdict\":\"undecided", "points in one place"]),
    ("line.xyz box.obj --translate 0,0,2", &["verdict\":\"undecided", "on a line", "100"]),
    ("floor.pcd point.xyz --translate 0,0,2", &["verdict\":\"undecided", "object", "in one place"]),
    ("holes.xyz box.obj --translate 0,0,0.5", &["verdict\":\"undecided", "33 %", "organised"]),
    (
        "floor.pcd box.obj --sensor iso:0.5 --translate 0,0,0.9",
        &["verdict\":\"undecided", "noise", "metres"],
    ),
    // A depth image.
    ("image.pcd box.obj --sensor kinect", &["verdict\":\"undecided", "unseen", "--max-unseen"]),
    (
        "image.pcd box.obj --sensor kinect --translate 0,0,-1",
        &["behind_camera\":1.0", "verdict\":\"undecided"],
    ),
    (
        "image.pcd box.obj --sensor kinect --translate 3,0,1",
        &["outside_view\":1.0", "verdict\":\"undecided"],
    ),
    (
        "image.pcd box.obj --sensor kinect --translate 0.6,0,1.5",
        &["hole\":", "verdict\":\"undecided"],
    ),
    (
        "image.pcd box.obj --sensor kinect --translate 0,0,2.4",
        &["behind_returns\":1.0", "verdict\":\"undecided"],
    ),
    (
        "image.pcd box.obj --sensor auto --translate 0,0,-1",
        &["\"kinect\"", "verdict\":\"undecided", "a depth image"],
    ),
    (
        "image.pcd box.obj --sensor lidar:0.02,0.003 --translate 0,0,2",
        &["sensor_layout", "--sensor auto"],
    ),
    (
        "base.pcd box.obj --sensor kinect --translate 1,0,0",
        &["sensor_pose", "--sensor-pose", "verdict\":\"undecided"],
    ),
    (
        "image.pcd box.obj --sensor kinect --sensor-pose 0,0,3 --translate 0,0,1",
        &["sensor_pose", "verdict\":\"undecided"],
    ),
    (
        "street.xyz car.obj --sensor kinect --translate 0,0,60",
        &["sensor_range", "--sensor auto", "verdict\":\"undecided"],
    ),
    // No time to look.
    ("floor.pcd floor_above.pcd --deadline 1", &[]),
    (
        "floor.pcd box.obj --cloud-unit mm --sensor exact --translate 0,0,1",
        &["verdict\":\"undecided", "0.346 m across", "--cloud-unit"],
    ),
    ("image_mm.pcd box.obj --translate 0,0,1", &["verdict\":\"undecided", "--cloud-unit mm"]),
    ("flat.obj floor.pcd --translate 0,0,1", &["verdict\":\"undecided", "span no surface"]),
    // The paper's path is no way round. As printed, a scene of a kilometre makes its kernel so wide that
    // everything in it collides.
    (
        "floor_mm.pcd box.obj --mode paper --translate 0,0,0.5",
        &["verdict\":\"in_collision", "--cloud-unit mm"],
    ),
    (
        "point.xyz box.obj --mode paper --translate 0,0,2",
        &["verdict\":\"undecided", "check the file"],
    ),
    (
        "image.pcd box.obj --mode paper --sensor kinect --translate 0,0,-1",
        &["verdict\":\"undecided", "unseen"],
    ),
];

/// What is refused: exit code 1, one line.
const REFUSED: &[Slip] = &[
    ("floor.pcd box.obj --sensor iso:5", &["floor.pcd", "noise is 5 m", "iso:0.005"]),
    (
        "floor.pcd floor_above.pcd --object-sensor iso:10 --mode paper",
        &["floor_above.pcd", "10 m", "iso:0.005"],
    ),
    (
        "image.pcd box.obj --sensor kinect --cloud-unit mm",
        &["image.pcd", "range removed 3744", "its unit"],
    ),
    ("image_mm.pcd box.obj --sensor kinect", &["image_mm.pcd", "across", "--cloud-unit mm"]),
    ("box.obj floor.pcd --robot gone.stl", &["gone.stl", "cannot be read"]),
    ("huge.pcd robot.dae", &["robot.dae", "\"dae\"", ".stl", "convert"]),
    ("robot.dae box.obj", &["robot.dae", "\"dae\"", "convert"]),
    ("scan.las box.obj", &["scan.las", "\"las\"", "convert"]),
    ("floor.pcd gone.obj", &["gone.obj", "cannot be read"]),
    ("floor.pcd box.obj --ply floor.pcd --force", &["floor.pcd", "is an input", "another file"]),
    ("floor.pcd box.obj --ply ./box.obj", &["box.obj", "is an input"]),
    ("floor.pcd box.obj --ply old.ply", &["old.ply", "is there already", "--force"]),
    ("floor.pcd box.obj --pose floor.pcd", &["floor.pcd", "cannot read the pose"]),
    ("floor.pcd box.obj --pose sheared.txt", &["sheared.txt", "not a rotation", "remove scale"]),
    ("floor.pcd box.obj --pose transposed.txt", &["transposed.txt", "last row", "row-major"]),
    ("floor.pcd box.obj --pose short.txt", &["short.txt", "found 12 numbers", "4x4"]),
    ("row.xyz box.obj", &["row.xyz: line 1", "300 values", "one point a line"]),
    ("short.xyz box.obj", &["short.xyz: line 2", "2 values", "expected 3"]),
    ("word.xyz box.obj", &["word.xyz: line 2", "\"abc\"", "write it like"]),
    ("comma.csv box.obj", &["comma.csv", "line 1"]),
    ("nan.xyz box.obj", &["nan.xyz", "no point is left of 2", "check the file"]),
    ("empty.xyz box.obj", &["empty.xyz", "empty"]),
    ("cut.pcd box.obj", &["cut.pcd", "1000", "rows"]),
    ("noise.pcd box.obj", &["noise.pcd", "line 1"]),
    ("cut.stl floor.pcd", &["cut.stl", "byte 80"]),
    ("corner.obj floor.pcd", &["corner.obj: line 4", "9", "vert"]),
    ("faceless.obj floor.pcd", &["faceless.obj: line 1", "no faces", "export it as a mesh"]),
    ("collapsed.obj floor.pcd", &["collapsed.obj: no triangle has an area, of 1", "check"]),
    ("floor.pcd box.obj --robot collapsed.obj", &["collapsed.obj: no triangle has an area"]),
    ("infinite.obj floor.pcd", &["infinite.obj: line 1", "inf", "finite"]),
    ("bad.ply floor.pcd", &["bad.ply", "line"]),
    ("floor.pcd box.obj --sensor per-point", &["floor.pcd", "covariance"]),
    ("floor.pcd box.obj --min-range 5", &["floor.pcd", "no point is left of 441", "loosen"]),
];

/// Options that the files have no use for, which they have to be read for: exit code 2, one line.
const UNUSED: &[Slip] = &[
    ("floor.pcd floor.pcd --unit mm", &["--unit is for meshes", "--cloud-unit"]),
    ("box.obj box.obj --cloud-unit mm", &["--cloud-unit is for clouds", "leave it out"]),
    ("box.obj box.obj --outliers 8,3", &["--outliers is for clouds", "leave it out"]),
    ("box.obj box.obj --sensor kinect", &["--sensor is for clouds", "leave it out"]),
    ("box.obj box.obj --sensor iso:0.005", &["--sensor is for clouds", "leave it out"]),
    ("box.obj box.obj --max-unseen 0.1", &["--max-unseen is for clouds", "leave it out"]),
    ("box.obj box.obj --max-missing 0.1", &["--max-missing is for clouds", "leave it out"]),
    ("box.obj box.obj --refine yes", &["--refine is for clouds", "leave it out"]),
    ("box.obj box.obj --refine auto", &["--refine is for clouds", "leave it out"]),
    ("floor.pcd box.obj --object-sensor kinect", &["--object-sensor is for", "no object is one"]),
    (
        "box.obj floor.pcd --sensor kinect --object-sensor iso:0.002",
        &["--sensor is for", "no scene is one"],
    ),
    ("box.obj floor.pcd --robot box.obj", &["box.obj", "--robot is for a scene that is a cloud"]),
    ("box.obj floor.pcd --collision-map 0.05", &["box.obj", "--collision-map", "leave it out"]),
    ("box.obj floor.pcd --sensor-pose 0,0,1", &["box.obj", "--sensor-pose", "leave it out"]),
];

/// Wrong usage: exit code 2, before any file is read.
const MISUSED: &[Slip] = &[
    ("floor.pcd box.obj --rotate-rpy 0,90,0", &["90 rad", "--rotate-deg 0,90,0"]),
    ("floor.pcd box.obj --rotate-rpy 180,0,0", &["180 rad", "--rotate-deg"]),
    ("floor.pcd box.obj --quaternion 1,2,3,4", &["--quaternion", "length"]),
    ("floor.pcd box.obj --quaternion 0,0,1", &["3 numbers", "x,y,z,w"]),
    ("floor.pcd box.obj --translate 0.4", &["1 numbers", "0.4,0,-1.2"]),
    ("floor.pcd box.obj --translate 0.4;0;1", &["`0.4;0;1` is not a number"]),
    ("floor.pcd box.obj --translate 0.1 0 0.7", &["'0'", "commas", "as in 0.1,0,0.7"]),
    ("--translate 0.1 0 0.7 floor.pcd box.obj", &["'0.1'", "commas", "as in 0.1,0,0.7"]),
    ("floor.pcd box.obj --sensor-pose 1 -2.5 3", &["'-2'", "commas", "as in 1,-2.5,3"]),
    ("floor.pcd box.obj --sensor kinect2", &["`kinect2`", "kinect"]),
    ("floor.pcd box.obj --sensor iso:5mm", &["`5mm`", "iso:STD"]),
    ("floor.pcd box.obj --sensor-pose 1,2,3,4", &["4 numbers", "write three, or seven"]),
    ("floor.pcd box.obj --unit metre", &["\"metre\"", "m, cm, mm or in"]),
    ("floor.pcd box.obj --outliers 100000,3", &["100000 neighbours", "200"]),
    ("floor.pcd box.obj --reject 10", &["0 to 0.5"]),
    ("floor.pcd box.obj --prior 0", &["above 0"]),
    ("floor.pcd box.obj --deadline -1", &["'-1'", "--deadline", "milliseconds, 1 or more"]),
    ("floor.pcd box.obj --deadline 0.5", &["'0.5'", "whole milliseconds"]),
    ("floor.pcd box.obj --max-points -1", &["invalid value '-1'", "--max-points"]),
    ("floor.pcd box.obj --max-unseen 5", &["0 to 1"]),
    ("floor.pcd box.obj --pooling max", &["--pooling", "--mode paper"]),
    ("floor.pcd box.obj --mode paper --refine yes", &["--refine", "leave it out"]),
    ("floor.pcd", &["<OBJECT>"]),
];

/// A folder with everything that the slips name.
fn inputs() -> Inputs {
    let inputs = Inputs::new();
    let cloud = |name: &str, cloud: &PointCloud| {
        cloudtouch_io::write_cloud_pcd(inputs.path(name), cloud).unwrap();
    };
    let moved = |cloud: &PointCloud, to: &dyn Fn(&Point3) -> Point3| PointCloud {
        points: cloud.points.iter().map(to).collect(),
        ..cloud.clone()
    };
    let (image, in_mm) = (image(), |p: &Point3| Point3::from(1000.0 * p.coords));
    cloud("floor_mm.pcd", &moved(&floor(), &in_mm));
    cloud("floor_above.pcd", &moved(&floor(), &|p| p + Vector3::new(0.0, 0.0, 0.002)));
    cloud("image.pcd", &image);
    cloud("image_mm.pcd", &moved(&image, &in_mm));
    cloud("base.pcd", &moved(&image, &|p| Point3::new(p.z, -p.x, -p.y)));
    for (name, half) in [("box_mm.obj", 100.0), ("car.obj", 1.0)] {
        cloudtouch_io::write_mesh_obj(inputs.path(name), &cube(half)).unwrap();
    }
    let rows = |count: i32, row: &dyn Fn(i32) -> String| (0..count).map(row).collect::<String>();
    let write = |name: &str, text: String| inputs.write(name, &text);
    write("point.xyz", "0.1 0.2 0.0\n".to_owned());
    write("same.xyz", "0.1 0.2 0.0\n".repeat(30));
    write("line.xyz", rows(100, &|i| format!("{} 0.5 0.25\n", 0.01 * f64::from(i))));
    write("far.xyz", rows(400, &|i| format!("{} {} 5.0\n", 512_700 + i % 20, 5_403_547 + i / 20)));
    write(
        "street.xyz",
        rows(900, &|i| {
            format!("{} {} 70\n", 0.5 * f64::from(i % 30) - 7.0, 0.5 * f64::from(i / 30) - 7.0)
        }),
    );
    let grid = |i: i32| format!("{} {} 0\n", 0.02 * f64::from(i % 30), 0.02 * f64::from(i / 30));
    write(
        "holes.xyz",
        rows(900, &|i| if i % 3 == 0 { "nan nan nan\n".to_owned() } else { grid(i) }),
    );
    write("row.xyz", rows(100, &|i| grid(i).replace('\n', " ")));
    write("short.xyz", "1 2 3\n4 5\n".to_owned());
    write("word.xyz", "1 2 3\n4 abc 6\n".to_owned());
    write("comma.csv", "1,5 2,5\n3,5 4,5\n".to_owned());
    write("nan.xyz", "nan nan nan\nnan nan nan\n".to_owned());
    write("empty.xyz", String::new());
    let header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1000\nDATA";
    write("cut.pcd", format!("{header} binary\n12345"));
    write("noise.pcd", "\u{1}\u{2}not a cloud\u{0}".repeat(9));
    // Reading it would take a while, or fail: neither may come first.
    write("huge.pcd", format!("{header} ascii\nbroken\n"));
    for name in ["robot.dae", "scan.las", "old.ply"] {
        write(name, "<COLLADA/>".to_owned());
    }
    write("cut.stl", format!("{:<80}\u{7f}\u{0}\u{0}\u{0}", "solid"));
    write("corner.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n".to_owned());
    write("faceless.obj", "v 0 0 0\nv 1 0 0\n".to_owned());
    write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n".to_owned());
    write("collapsed.obj", "v 1 2 3\nv 1 2 3\nv 0 1 0\nf 1 2 3\n".to_owned());
    write("infinite.obj", "v 0 0 inf\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned());
    write("bad.ply", "ply\nformat ascii 1.0\nelement vertex -3\nend_header\n".to_owned());
    let pose = |first: &str, last: &str| format!("{first}\n0 1 0 0\n0 0 1 0\n{last}\n");
    write("mm.txt", pose("1 0 0 400", "0 0 0 1"));
    write("sheared.txt", pose("1 0.5 0 0", "0 0 0 1"));
    write("transposed.txt", pose("1 0 0 0", "0.4 0 0.2 1"));
    write("short.txt", "1 0 0 0 0 1 0 0 0 0 1 0".to_owned());
    inputs
}

/// A wall 2 m before the camera, with a hole to the right of the middle.
fn image() -> PointCloud {
    let (width, height, focal) = (80_i32, 60_i32, 70.0);
    let pixel = |i: i32| {
        let (u, v) = (f64::from(i % width) - 39.5, f64::from(i / width) - 29.5);
        let is_hole = u > 15.0 && u < 39.0 && v.abs() < 22.0;
        let depth = if is_hole { f64::NAN } else { 2.0 };
        Point3::new(u / focal * depth, v / focal * depth, depth)
    };
    let points = (0..width * height).map(pixel).collect();
    let image_size = Some((width as usize, height as usize));
    PointCloud { image_size, ..PointCloud::from_points(points) }
}

/// Runs each slip, with these arguments first; what it said, by exit code, is checked by `check`.
fn each(slips: &[Slip], first: &[&str], check: impl Fn(i32, &str, &str) -> Option<String>) {
    let inputs = inputs();
    let mut problems = Vec::new();
    for (slip, parts) in slips {
        let arguments: Vec<&str> = first.iter().copied().chain(slip.split(' ')).collect();
        let run = inputs.run(&arguments);
        let (code, out, err) = (run.code(), run.stdout(), run.stderr());
        let said = format!("{out}{err}");
        println!("{slip}\n  [{code}] {}", said.trim_end());
        let missing = parts.iter().filter(|part| !said.contains(**part));
        problems.extend(missing.map(|part| format!("{slip}: no {part} in {said}")));
        problems
            .extend(check(code, &out, &err).map(|problem| format!("{slip}: {problem}: {said}")));
        if out.contains("\"verdict\":\"free\"") || err.contains("panicked") {
            problems.push(format!("{slip}: {said}"));
        }
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn what_cannot_be_meant_is_not_free_and_says_why() {
    each(DOUBTED, &["query", "--json"], |code, out, _| {
        let report: Value = match serde_json::from_str(out) {
            Ok(report) => report,
            Err(error) => return Some(format!("no report: {error}")),
        };
        let is_told = report["verdict"] != "undecided" || report["undecided_by"].is_string();
        (code != 0 || !is_told).then(|| format!("exit code {code}"))
    });
}

#[test]
fn what_is_wrong_is_refused_in_one_line() {
    each(REFUSED, &["query", "--json"], |code, out, err| {
        let is_one_line = err.starts_with("error: ") && err.lines().count() == 1;
        (code != 1 || !out.is_empty() || !is_one_line).then(|| format!("exit code {code}"))
    });
}

/// They gave 1, as a broken file does, where other wrong options give 2.
#[test]
fn options_that_the_files_have_no_use_for_were_no_wrong_usage() {
    each(UNUSED, &["query", "--json"], |code, out, err| {
        let is_one_line = err.starts_with("error: ") && err.lines().count() == 1;
        (code != 2 || !out.is_empty() || !is_one_line).then(|| format!("exit code {code}"))
    });
}

#[test]
fn what_is_misused_is_told_before_any_work() {
    each(MISUSED, &["query"], |code, out, err| {
        let has_usage = err.contains("Usage") || err.contains("--help");
        (code != 2 || !out.is_empty() || !has_usage).then(|| format!("exit code {code}"))
    });
}

/// The same files and poses as they were meant.
#[test]
fn what_was_meant_is_free() {
    let inputs = inputs();
    for arguments in [
        "floor.pcd box.obj --translate 0,0,0.5",
        "floor_mm.pcd box.obj --cloud-unit mm --translate 0,0,0.5",
        "floor.pcd box_mm.obj --unit mm --translate 0,0,0.5",
        "floor.pcd box.obj --rotate-deg 0,90,0 --translate 0,0,0.5",
        "floor.pcd box.obj --quaternion 0,0,0.7071,0.7071 --translate 0,0,0.5",
        "image.pcd box.obj --sensor kinect --translate -0.2,0,1.2",
        "image.pcd box.obj --sensor auto --translate -0.2,0,1.2",
        "image_mm.pcd box.obj --cloud-unit mm --sensor kinect --translate -0.2,0,1.2",
        "base.pcd box.obj --sensor kinect --sensor-pose 0,0,0,-0.5,0.5,-0.5,0.5 --translate 1.2,0.2,0",
        "street.xyz car.obj --sensor auto --translate 0,0,60",
        "floor.pcd box.obj --translate 10,20,500 --trust-units",
        "image.pcd box.obj --sensor kinect --translate 3,0,1 --max-unseen 1",
        "holes.xyz box.obj --translate 0.3,0.3,0.5 --max-missing 0.5",
    ] {
        let run = inputs
            .run(&[&["query", "--json"][..], &arguments.split(' ').collect::<Vec<_>>()].concat());
        let report = run.json_lines().pop();
        assert!(
            report.is_some_and(|r| r["verdict"] == "free"),
            "{arguments}: {}{}",
            run.stdout(),
            run.stderr()
        );
    }
}

/// A slip in a case is an error in its place, or a verdict that is not free.
#[test]
fn slips_in_a_batch() {
    let inputs = inputs();
    let case = |scene: &str, object: &str, height: f64| {
        case_at("a", height).replace("floor.pcd", scene).replace("box.obj", object)
    };
    let slips = [
        (case("floor_mm.pcd", "box.obj", 0.5), "--cloud-unit mm"),
        (case("floor.pcd", "box_mm.obj", 0.5), "--unit mm"),
        (case("floor.pcd", "box.obj", 500.0), "check the pose"),
        (case("point.xyz", "box.obj", 0.5), "check the file"),
        (case("floor.pcd", "robot.dae", 0.5), "convert"),
        (case("floor.pcd", "gone.obj", 0.5), "gone.obj: cannot be read"),
        (case("floor.pcd", "box.obj", 0.5).replace("iso:0.002", "iso:5"), "iso:0.005"),
        (case("floor.pcd", "box.obj", 0.5).replace("[0,0,1,0.5]", "[0,0,1,NaN]"), "four numbers"),
        (case("floor.pcd", "box.obj", 0.5).replace("[0,0,1,0.5]", "[0,0,1,1e400]"), "out of range"),
        (case("floor.pcd", "box.obj", 0.5).replace("[0,0,0,1]", "[0,0,0,2]"), "last row"),
        ("[]".to_owned(), "not a JSON object"),
    ];
    let cases: Vec<String> =
        slips.iter().map(|(case, _)| case.clone()).chain([case_at("good", 0.5)]).collect();
    inputs.write("cases.json", &case_file(&cases));
    let lines = inputs.run(&["batch", "cases.json", "--json"]);
    assert_eq!(lines.code(), 1);
    let lines = lines.json_lines();
    assert_eq!(lines.len(), slips.len() + 1);
    for ((case, part), line) in slips.iter().zip(&lines) {
        assert!(line["verdict"] != "free" && line.to_string().contains(part), "{case}: {line}");
    }
    assert_eq!(lines[slips.len()]["verdict"], "free");
}
