//! `cloudtouch query`: answers, poses, pictures.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support;
use crate::support::{HEIGHTS, Inputs};

#[test]
fn says_free_uncertain_and_in_collision() {
    let inputs = Inputs::new();
    for (verdict, _, height) in HEIGHTS {
        let answer = &inputs.query_at(height, &["--json"]).quiet(0).json_lines()[0];
        assert_eq!(answer["verdict"], verdict, "at {height} m: {answer}");
        let text = inputs.query_at(height, &[]).quiet(0).stdout();
        assert!(text.contains(&verdict.replace('_', " ")), "{text}");
        assert!(text.contains("441 points") && text.contains("watertight mesh of 12"), "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    }
}

#[test]
fn a_pose_file_and_options_say_the_same() {
    let inputs = Inputs::new();
    // A quarter turn about z.
    inputs.write("pose.txt", "[[0,-1,0,0.01],\n [1,0,0,0.02],\n [0,0,1,0.11],\n [0,0,0,1]]\n");
    let arguments = ["query", "floor.pcd", "box.obj", "--sensor=iso:0.002", "--json"];
    let from_file = inputs.run(&[&arguments[..], &["--pose", "pose.txt"]].concat()).quiet(0);
    let options = ["--translate", "0.01,0.02,0.11", "--rotate-rpy", "0,0,1.5707963267948966"];
    let from_options = inputs.run(&[&arguments[..], &options].concat()).quiet(0);
    let probability = |run: &support::Run| run.json_lines()[0]["collision_probability"].as_f64();
    let (a, b) = (probability(&from_file).unwrap(), probability(&from_options).unwrap());
    assert!(a > 0.0 && (a - b).abs() < 1e-9, "{a} {b}");
}

/// Who said that the sensor stood at the origin was taken to have said nothing.
#[test]
fn an_object_in_a_room_that_was_scanned_from_its_origin_was_undecided() {
    let inputs = Inputs::new();
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let dome = |i: u32| {
        let z = (f64::from(i) + 0.5) / 2000.0 - 1.0;
        let (radius, turn) = ((1.0 - z * z).sqrt(), golden * f64::from(i));
        format!("{} {} {}\n", radius * turn.cos(), radius * turn.sin(), z)
    };
    inputs.write("dome.xyz", &(0..4000).map(dome).collect::<String>());
    let ask = |more: &[&str]| {
        let within = ["query", "dome.xyz", "box.obj", "--translate=0.3,0,0"];
        inputs.run(&[&within[..], more].concat()).quiet(0).stdout()
    };
    let unsaid = ask(&[]);
    assert!(unsaid.contains("undecided") && unsaid.contains("--sensor-pose"), "{unsaid}");
    assert!(unsaid.lines().all(|line| line.chars().count() <= 100), "{unsaid}");
    let said = ask(&["--sensor-pose", "0,0,0"]);
    assert!(said.contains("verdict                free"), "{said}");
    // What was given is not asked for again.
    let from_outside = ask(&["--sensor-pose", "0,0,3"]);
    let words = from_outside.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("undecided: one surface is all around the other"), "{from_outside}");
    assert!(!words.contains("(--sensor-pose)") && words.contains("look from elsewhere"), "{words}");
}

/// An array as numpy saves it was told by what reading it said of UTF-8.
#[test]
fn a_pose_that_is_no_text_is_told_as_such() {
    let inputs = Inputs::new();
    std::fs::write(inputs.path("pose.npy"), b"\x93NUMPY\x01\x00v\x00\xf0\x3f").unwrap();
    for arguments in [["query", "--pose"], ["path", "--poses"]] {
        let [command, option] = arguments;
        let run = inputs.run(&[command, "floor.pcd", "box.obj", option, "pose.npy"]);
        assert_eq!(run.code(), 1);
        let told = run.stderr();
        assert!(
            told.contains("pose.npy: cannot read the p") && told.contains("it is no text"),
            "{told}"
        );
    }
}

#[test]
fn negative_numbers_need_no_equals_sign() {
    let inputs = Inputs::new();
    let run = inputs.run(&[
        "query",
        "floor.pcd",
        "box.obj",
        "--translate",
        "-1,2,3",
        "--rotate-rpy",
        "-1,0,0",
    ]);
    run.quiet(0);
}

#[test]
fn a_mesh_in_millimetres_is_scaled_and_the_cloud_is_not() {
    let inputs = Inputs::new();
    cloudtouch_io::write_mesh_obj(inputs.path("mm.obj"), &support::cube(100.0)).unwrap();
    let pose = "--translate=0.01,0.02,0.1";
    let run = |file: &str, unit: &str| {
        let scene = ["query", "floor.pcd", file, "--sensor=iso:0.002", pose, "--json"];
        inputs.run(&[&scene[..], &["--unit", unit]].concat())
    };
    let right = run("mm.obj", "mm").quiet(0).json_lines().remove(0);
    let reference = run("box.obj", "m").quiet(0).json_lines().remove(0);
    let gap = |v: &serde_json::Value| v["clearance_m"]["mean"].as_f64().unwrap();
    assert!((gap(&right) - gap(&reference)).abs() < 1e-9, "{right} {reference}");
    // Without the unit there is an answer, and a warning beside it.
    let wrong = run("mm.obj", "m");
    assert_eq!(wrong.code(), 0);
    assert!(wrong.stderr().contains("--unit mm"), "{}", wrong.stderr());
    assert_eq!(wrong.json_lines().len(), 1);
}

#[test]
fn covariance_columns_that_are_passed_over_are_mentioned() {
    let inputs = Inputs::new();
    let mut cloud = support::floor();
    let covariance = cloudtouch::geom::Covariance::isotropic(1e-4);
    cloud.covariances = Some(vec![covariance; cloud.points.len()]);
    cloudtouch_io::write_cloud_pcd(inputs.path("known.pcd"), &cloud).unwrap();
    let loud = inputs.run(&["query", "known.pcd", "box.obj"]);
    assert!(loud.stderr().contains("--sensor per-point"), "{}", loud.stderr());
    inputs.run(&["query", "known.pcd", "box.obj", "--sensor", "per-point"]).quiet(0);
}

#[test]
fn the_picture_has_colours_and_probabilities() {
    let inputs = Inputs::new();
    let answer = inputs.query_at(0.1, &["--json", "--ply", "out.ply"]).quiet(0).json_lines();
    let bytes = std::fs::read(inputs.path("out.ply")).unwrap();
    let header_end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let header = String::from_utf8(bytes[..header_end].to_vec()).unwrap();
    assert!(header.contains("property uchar red"), "{header}");
    assert!(header.contains("property float probability"), "{header}");
    // The box is in it as a mesh.
    assert!(header.contains("element face 12\n"), "{header}");
    // x, y, z, three colours, probability; the faces come after all of them.
    let row = 3 * 4 + 3 + 4;
    let points = bytes.len() - header_end - 12 * 13;
    assert_eq!(points % row, 0);
    let rows = bytes[header_end..header_end + points].chunks_exact(row);
    let probability = |r: &[u8]| f32::from_le_bytes(r[row - 4..].try_into().unwrap());
    let largest = rows.map(probability).fold(0.0, f32::max);
    let expected = answer[0]["collision_probability"].as_f64().unwrap();
    assert_eq!(largest, expected as f32);
}

#[test]
fn the_same_query_gives_the_same_answer() {
    let inputs = Inputs::new();
    let answer = || {
        let mut answer = inputs.query_at(0.1, &["--json"]).json_lines().remove(0);
        let stats = answer["stats"].as_object_mut().unwrap();
        stats.remove("prepare_us");
        stats.remove("query_us");
        answer
    };
    assert_eq!(answer(), answer());
}

#[test]
fn the_picture_keeps_the_colours_of_the_scan() {
    let inputs = Inputs::new();
    let floor = support::floor().points;
    let colors: Vec<[u8; 3]> = (0..floor.len()).map(|i| [i as u8, 40, 200]).collect();
    cloudtouch_io::write_colored_ply(inputs.path("a.ply"), &floor, &colors, None, &[]).unwrap();
    let arguments = ["query", "a.ply", "floor.pcd", "--translate=0,0,0.6", "--ply", "out.ply"];
    inputs.run(&arguments).quiet(0);
    let limits = Default::default();
    let painted = cloudtouch_io::read_colors_within(inputs.path("out.ply"), &limits).unwrap();
    let painted = painted.unwrap();
    assert_eq!(painted[..floor.len()], colors);
    assert!(painted[floor.len()..].iter().all(|color| *color == [70, 130, 220]));
}

/// Whoever writes w first means no turn; it was half a turn about x without a word.
#[test]
fn no_turn_with_w_first_was_half_a_turn_in_silence() {
    let inputs = Inputs::new();
    let run = inputs.query_at(0.5, &["--quaternion=1,0,0,0", "--json"]);
    let answer = run.json_lines().remove(0);
    assert_eq!((run.code(), &answer["verdict"]), (0, &"free".into()), "{}", run.stderr());
    let warnings = answer["warnings"].as_array().unwrap();
    let warning = warnings.iter().find(|warning| warning["code"] == "quaternion_order").unwrap();
    for part in ["--quaternion 1,0,0,0", "0,0,0,1", "--rotate-deg 180,0,0"] {
        assert!(warning["words"].as_str().unwrap().contains(part), "{warning}");
        assert!(run.stderr().contains(part), "{}", run.stderr());
    }
    for turn in ["--quaternion=0,0,0,1", "--quaternion=0,1,0,0", "--rotate-deg=180,0,0"] {
        inputs.query_at(0.5, &[turn, "--json"]).quiet(0);
    }
}

/// A cloud without layout had no line about it, as if all had been seen.
#[test]
fn what_was_not_seen_is_said_to_be_unknown_without_a_depth_image() {
    let inputs = Inputs::new();
    let told = "\nunseen                 not known (no rows and columns): ";
    let text = inputs.query_at(0.5, &[]).quiet(0).stdout();
    assert!(text.contains(told), "{text}");
    assert!(!inputs.query_at(0.5, &["--mode=paper"]).stdout().contains("\nunseen"));
    let mut wall = support::floor();
    wall.points.iter_mut().for_each(|point| point.z = 1.0);
    wall.image_size = Some((21, 21));
    cloudtouch_io::write_cloud_pcd(inputs.path("wall.pcd"), &wall).unwrap();
    for arguments in [["wall.pcd", "box.obj"], ["box.obj", "box.obj"]] {
        let text = inputs.run(&[&["query"], &arguments[..]].concat()).stdout();
        assert!(text.contains("verdict") && !text.contains(told), "{text}");
    }
}

/// A deviation of 1 m, meant in millimetres, left a pose free whose neighbours collide.
#[test]
fn a_free_pose_that_is_known_too_roughly_is_told_so() {
    let inputs = Inputs::new();
    let told = |stds: &str| inputs.query_at(0.5, &["--pose-std", stds]).stderr();
    let rough = told("0,0,0.5,0,0,0");
    assert!(
        rough.contains("over those that --pose-std allows, a collision has up to 0."),
        "{rough}"
    );
    assert_eq!(told("0,0,0.001,0,0,0"), "");
}

/// It told the sensor that was stated, by which nothing had been computed.
#[test]
fn the_sensor_of_a_collision_map_is_its_grid() {
    let inputs = Inputs::new();
    let answer = &inputs.query_at(0.5, &["--collision-map=0.1", "--json"]).json_lines()[0];
    assert_eq!(answer["scene"]["sensor"], "grid:0.1", "{answer}");
}

/// Cells finer than the noise keep it, and count as noise no larger than a cell.
#[test]
fn a_collision_map_finer_than_the_noise_took_the_noise_away_in_silence() {
    let inputs = Inputs::new();
    let told = |map: &str| inputs.query_at(0.5, &[map]).stderr();
    for part in ["--collision-map 0.001", "--sensor iso:0.002", "several times the noise"] {
        assert!(told("--collision-map=0.001").contains(part), "{}", told("--collision-map=0.001"));
    }
    assert_eq!(told("--collision-map=0.1"), "");
}

/// Its colours were looked for in a second reading, of a pipe that nobody writes to any more: it waited for ever.
#[cfg(target_os = "linux")]
#[test]
fn a_picture_of_a_scan_from_a_pipe_was_never_done() {
    let inputs = Inputs::new();
    let pipe = inputs.path("scan.pcd");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let scan = std::fs::read(inputs.path("floor.pcd")).unwrap();
    std::thread::spawn(move || std::fs::write(pipe, scan));
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_cloudtouch"));
    let arguments = ["query", "scan.pcd", "box.obj", "--translate=0,0,0.5", "--ply=o.ply"];
    command.current_dir(inputs.path("")).args(arguments);
    let mut tool = command.stdout(std::process::Stdio::null()).spawn().unwrap();
    let begun = std::time::Instant::now();
    let code = loop {
        match tool.try_wait().unwrap() {
            Some(status) => break status.code(),
            None if begun.elapsed().as_secs() < 60 => {
                std::thread::sleep(std::time::Duration::from_millis(20))
            }
            None => {
                tool.kill().unwrap();
                break None;
            }
        }
    };
    assert!(code == Some(0) && inputs.names().contains(&"o.ply".to_owned()), "{code:?}");
}
