//! 0 done, 1 error, 2 wrong usage; the verdict with `--exit-code`.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::{HEIGHTS, Inputs, case_at, case_file};
use cloudtouch::geom::{Point3, PointCloud};

#[test]
fn the_verdict_is_the_exit_code_when_asked_for() {
    let inputs = Inputs::new();
    for (_, code, height) in HEIGHTS {
        inputs.query_at(height, &["--exit-code"]).quiet(code);
        inputs.query_at(height, &["--exit-code", "--json"]).quiet(code);
        inputs.query_at(height, &[]).quiet(0);
    }
}

/// An object behind a dome that a depth camera saw from outside: nothing is known there.
#[test]
fn a_place_that_was_never_seen_is_undecided() {
    let inputs = Inputs::new();
    let points = (0..40 * 40)
        .map(|i| (0.02 * (f64::from(i % 40) - 19.5), 0.02 * (f64::from(i / 40) - 19.5)))
        .map(|(x, y)| Point3::new(x, y, 1.0 + 2.0 * (x * x + y * y)))
        .collect();
    let mut dome = PointCloud::from_points(points);
    dome.image_size = Some((40, 40));
    cloudtouch_io::write_cloud_pcd(inputs.path("dome.pcd"), &dome).unwrap();
    let arguments = ["query", "dome.pcd", "box.obj", "--exit-code", "--translate", "0,0,1.3"];
    let run = inputs.run(&arguments).quiet(30);
    assert!(run.stdout().contains("verdict                undecided"), "{}", run.stdout());
}

#[test]
fn errors_are_1_also_with_exit_code() {
    let inputs = Inputs::new();
    assert_eq!(inputs.run(&["query", "gone.pcd", "box.obj", "--exit-code"]).code(), 1);
    assert_eq!(inputs.run(&["batch", "gone.json"]).code(), 1);
    assert_eq!(inputs.run(&["info", "gone.pcd"]).code(), 1);
}

#[test]
fn wrong_usage_is_2() {
    let inputs = Inputs::new();
    for arguments in [
        &[][..],
        &["fly"],
        &["query"],
        &["query", "floor.pcd"],
        &["query", "floor.pcd", "box.obj", "--sensor", "sonar"],
        &["query", "floor.pcd", "box.obj", "--sensor", "iso:-1"],
        &["query", "floor.pcd", "box.obj", "--accept", "0.4"],
        &["query", "floor.pcd", "box.obj", "--reject", "0.6"],
        &["query", "floor.pcd", "box.obj", "--accept", "nan"],
        &["query", "floor.pcd", "box.obj", "--translate", "1,2"],
        &["query", "floor.pcd", "box.obj", "--translate", "1,2,nan"],
        &["query", "floor.pcd", "box.obj", "--rotate-rpy", "1,2,inf"],
        &["query", "floor.pcd", "box.obj", "--rotate-rpy", "0,90,0"],
        &["query", "floor.pcd", "box.obj", "--quaternion", "0,0,0,2"],
        &["query", "floor.pcd", "box.obj", "--rotate-deg", "0,90,0", "--rotate-rpy", "0,1,0"],
        &["query", "floor.pcd", "box.obj", "--outliers", "100000,3"],
        &["query", "floor.pcd", "box.obj", "--deadline", "0"],
        &["query", "floor.pcd", "box.obj", "--robot-padding", "0.1"],
        &["query", "floor.pcd", "box.obj", "--pose", "p.txt", "--translate", "1,2,3"],
        &["query", "floor.pcd", "box.obj", "--unit", "furlong"],
        &["query", "floor.pcd", "box.obj", "--outliers", "0,3"],
        &["query", "floor.pcd", "box.obj", "--outliers", "8,-3"],
        &["query", "floor.pcd", "box.obj", "--min-range=-1"],
        &["query", "floor.pcd", "box.obj", "--min-range", "5", "--max-range", "1"],
        &["query", "floor.pcd", "box.obj", "--max-range", "0"],
        &["query", "floor.pcd", "box.obj", "--translate", "1e300,0,0"],
        &["query", "floor.pcd", "box.obj", "--pose-std", "1e300,0,0,0,0,0"],
        &["query", "floor.pcd", "box.obj", "--sensor", "iso:1e300"],
        &["query", "floor.pcd", "box.obj", "--sensor-pose", "1e300,0,0"],
        &["path", "floor.pcd", "box.obj", "--poses", "path.csv", "--tolerance", "1e-9"],
        &["query", "floor.pcd", "box.obj", "--collision-map", "0"],
        &["query", "floor.pcd", "box.obj", "--seed", "3"],
        &["batch", "cases.json", "--pooling", "noisy-or", "--mode", "calibrated"],
        &["batch", "cases.json", "--sensor-for", "kinect"],
        &["batch", "cases.json", "--sensor-for", "=kinect"],
    ] {
        let run = inputs.run(arguments);
        assert_eq!((run.code(), run.stdout().as_str()), (2, ""), "{arguments:?}");
        assert!(run.stderr().contains("Usage") || run.stderr().contains("--help"));
    }
}

/// Found by the library, they were errors (1) that named no option.
#[test]
fn impossible_values_are_told_with_the_option_they_were_given_to() {
    let inputs = Inputs::new();
    for (options, told) in [
        ("--translate 1e11,0,0", &["--translate", "1e11 m is beyond 1e10 m"][..]),
        ("--pose-std 1e11,0,0,0,0,0", &["--pose-std", "1e11 m is beyond 1e10 m"]),
        ("--sensor-pose 1e11,0,0", &["--sensor-pose", "1e11 m is beyond 1e10 m"]),
        ("--min-range=2 --max-range=1", &["--min-range 2", "--max-range 1", "smaller first"]),
    ] {
        let given = ["query", "floor.pcd", "box.obj"].into_iter().chain(options.split(' '));
        let run = inputs.run(&given.collect::<Vec<_>>());
        assert_eq!((run.code(), run.stdout().as_str()), (2, ""), "{options}");
        let error = run.stderr();
        assert!(told.iter().all(|words| error.contains(words)), "{options}: {error}");
    }
}

#[test]
fn help_and_version_are_0_and_fit_a_terminal() {
    let inputs = Inputs::new();
    inputs.run(&["--version"]).quiet(0);
    for arguments in [
        &["--help"][..],
        &["query", "--help"],
        &["batch", "--help"],
        &["path", "--help"],
        &["scene", "--help"],
        &["robot", "--help"],
        &["info", "--help"],
        &["demo", "--help"],
    ] {
        let text = inputs.run(arguments).quiet(0).stdout();
        let long: Vec<&str> = text.lines().filter(|l| l.chars().count() > 100).collect();
        assert!(long.is_empty(), "{long:#?}");
    }
}

/// A reader that closes the pipe ends nothing, and turns no collision into a success.
#[test]
fn a_closed_pipe_keeps_the_exit_code() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &case_file(&[case_at("a", 0.5)]));
    let code = |arguments: &[&str]| {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("cloudtouch"));
        command.current_dir(inputs.path("")).args(arguments).stdout(writer);
        let output = command.stderr(std::process::Stdio::piped()).spawn().unwrap();
        let output = output.wait_with_output().unwrap();
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
        output.status.code().unwrap()
    };
    let query = ["query", "floor.pcd", "box.obj", "--translate=0,0,0.05", "--exit-code"];
    assert_eq!(code(&query), 20);
    assert_eq!(code(&["batch", "cases.json"]), 0);
    assert_eq!(code(&["demo"]), 0);
}
