//! Error messages: on standard error, with the file, what was found and what to do.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support;
use crate::support::Inputs;

/// Runs the tool, which has to fail with one line that has all `parts`, and prints nothing.
fn check(inputs: &Inputs, arguments: &[&str], parts: &[&str]) {
    let before = inputs.names();
    let run = inputs.run(arguments);
    let error = run.stderr();
    assert_eq!((run.code(), run.stdout().as_str()), (1, ""), "{arguments:?}: {error}");
    assert!(error.starts_with("error: ") && error.lines().count() == 1, "{error}");
    for part in parts {
        assert!(error.contains(part), "`{part}` is not in: {error}");
    }
    assert_eq!(inputs.names(), before, "{arguments:?} left something behind");
}

#[test]
fn files_that_cannot_be_read() {
    let inputs = Inputs::new();
    inputs.write("empty.pcd", "");
    inputs.write("cut.xyz", "1 2 3\n4 5\n");
    inputs.write("notes.docx", "hello");
    std::fs::create_dir(inputs.path("folder.pcd")).unwrap();
    for (file, parts) in [
        ("gone.pcd", &["gone.pcd: cannot be read: No such file"][..]),
        ("gone", &["gone: cannot be read: No such file"]),
        ("-", &["-: cannot be read: ", "standard input is not read"]),
        ("~/gone.pcd", &["~/gone.pcd: cannot be read: ", "write the whole path"]),
        ("empty.pcd", &["empty.pcd", "empty"]),
        ("folder.pcd", &["folder.pcd: is a folder"]),
        (".", &[".: is a folder"]),
        ("notes.docx", &["notes.docx", "docx", ".pcd"]),
        ("cut.xyz", &["cut.xyz", "line 2", "2 values"]),
    ] {
        check(&inputs, &["query", file, "box.obj"], parts);
        check(&inputs, &["query", "floor.pcd", file], parts);
        check(&inputs, &["info", file], parts);
    }
}

/// Of files other than clouds and meshes it was told what the system says, "os error 21".
#[test]
fn folders_in_the_place_of_other_files() {
    let inputs = Inputs::new();
    std::fs::create_dir(inputs.path("d.json")).unwrap();
    for arguments in [
        &["batch", "d.json"][..],
        &["scene", "d.json"],
        &["query", "floor.pcd", "box.obj", "--pose", "d.json"],
    ] {
        check(&inputs, arguments, &["d.json", "is a folder: give"]);
    }
}

#[test]
fn clouds_with_nothing_in_them() {
    let inputs = Inputs::new();
    inputs.write("nan.xyz", "nan nan nan\nnan nan nan\n");
    check(&inputs, &["query", "nan.xyz", "box.obj"], &["nan.xyz", "no point is left of 2"]);
    let far = ["query", "floor.pcd", "box.obj", "--min-range", "100"];
    check(&inputs, &far, &["floor.pcd", "no point is left of 441", "range removed 441"]);
    let columns = ["query", "floor.pcd", "box.obj", "--sensor", "per-point"];
    check(&inputs, &columns, &["floor.pcd", "covariance"]);
}

/// All files were named, and not which of them it was.
#[test]
fn of_several_scans_the_one_at_fault_is_named() {
    let inputs = Inputs::new();
    inputs.write("nan.xyz", "nan nan nan\nnan nan nan\n");
    inputs.write("far.xyz", "0 0 0\n0 1 0\n1e12 0 0\n");
    std::fs::copy(inputs.path("floor.pcd"), inputs.path("copy.pcd")).unwrap();
    for (also, told) in [
        ("nan.xyz", "error: nan.xyz: no point is left of 2"),
        ("far.xyz", "error: far.xyz: point 2 has the coordinate 1e12"),
        ("copy.pcd", "error: copy.pcd: scan 2 is one of those before it"),
    ] {
        let arguments = ["query", "floor.pcd", "box.obj", "--sensor=iso:0.002", "--also", also];
        check(&inputs, &arguments, &[told]);
    }
}

#[test]
fn pose_files() {
    let inputs = Inputs::new();
    let rest = "0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    for (text, parts) in [
        (format!("1 0 0 nan\n{rest}"), &["pose.txt", "(0, 3) is NaN", "finite"][..]),
        (format!("1 0 0 inf\n{rest}"), &["pose.txt", "(0, 3) is inf", "finite"]),
        (format!("2 0 0 0\n{rest}"), &["pose.txt", "not a rotation", "remove scale"]),
        (format!("-1 0 0 0\n{rest}"), &["pose.txt", "mirrors"]),
        ("1 0 0 0 0 1 0 0 0 0 1 0 5 0 0 1".to_owned(), &["pose.txt", "last row", "row-major"]),
        ("1 2 3".to_owned(), &["pose.txt", "found 3 numbers", "16"]),
        (format!("1 0 0 west\n{rest}"), &["pose.txt", "line 1", "`west`"]),
        // No file was named.
        (format!("1 0 0 -1e11\n{rest}"), &["pose.txt: (0, 3) is -1e11", "at most 1e10 m"]),
    ] {
        inputs.write("pose.txt", &text);
        check(&inputs, &["query", "floor.pcd", "box.obj", "--pose", "pose.txt"], parts);
    }
    let gone = ["query", "floor.pcd", "box.obj", "--pose", "gone.txt"];
    check(&inputs, &gone, &["gone.txt: cannot read the pose"]);
}

#[test]
fn case_files() {
    let inputs = Inputs::new();
    for (text, parts) in [
        ("", &["cases.json", "not a case file", "line 1"][..]),
        ("[1]", &["cases.json", "not a case file but a list", "\"cases\""]),
        (r#"{"format":1,"length_unit":"m"}"#, &["missing field `cases`"]),
        (r#"{"format":2,"length_unit":"m","cases":[]}"#, &["format 2", "format 1"]),
        (r#"{"format":1,"length_unit":"mm","cases":[]}"#, &["`mm`", "metres"]),
        (r#"{"format":1,"length_unit":"m","cases":[{"pose":}]}"#, &["line 1 column"]),
        (r#"{"format":1,"length_unit":"m","cases":[]}"#, &["there are no cases"]),
    ] {
        inputs.write("cases.json", text);
        check(&inputs, &["batch", "cases.json"], parts);
    }
    check(&inputs, &["batch", "floor.pcd"], &["floor.pcd: not a case file"]);
    check(&inputs, &["batch", "gone.json"], &["gone.json: cannot be read"]);
    check(&inputs, &["batch", "."], &[".: cannot be read"]);
}

/// A number below zero was taken for an option, and a wrong name of a sensor got no hint.
#[test]
fn options_that_cannot_be_meant() {
    let inputs = Inputs::new();
    for (more, parts) in [
        (["--reject", "-1"], &["-1", "--reject <B>"][..]),
        (["--margin", "-0.1"], &["-0.1", "--margin <METRES>"]),
        (["--pose-std", "-1,0,0,0,0,0"], &["-1 is negative"]),
        (
            ["--pose-std", "1,0,x,0,0,0"],
            &["`x` is not a number", "six, three in m and three in rad"],
        ),
        (["--sensor", "Kinect"], &["unknown sensor `Kinect`", "write `kinect`"]),
        (["--sensor", "realsense"], &["unknown sensor `realsense`", "or auto", "stereo:BASELINE"]),
        (["--sensor", "stereo:90,570,0.2"], &["90 m", "in millimetres?"]),
    ] {
        let run = inputs.run(&[&["query", "floor.pcd", "box.obj"], &more[..]].concat());
        assert_eq!(run.code(), 2, "{}", run.stderr());
        for part in parts {
            assert!(run.stderr().contains(part), "`{part}` is not in {}", run.stderr());
        }
        assert!(!run.stderr().contains("unexpected argument"), "{}", run.stderr());
        assert!(!run.stderr().contains("cloudtouch-cli"), "{}", run.stderr());
    }
}

/// The number was unexpected, and nothing said what to write.
#[test]
fn numbers_behind_options_that_take_none_there() {
    let inputs = Inputs::new();
    for (more, tip) in [
        (["--penetration", "0.2"], "--penetration is written with `=`: --penetration=0.2"),
        (["--penetration", "0,2"], "--penetration is written with `=`: --penetration=0,2"),
        (["--gradient", "1"], "--gradient takes no value: leave 1 out"),
    ] {
        for arguments in [
            [&["query", "floor.pcd", "box.obj"], &more[..]].concat(),
            [&["query"], &more[..], &["floor.pcd", "box.obj"]].concat(),
        ] {
            let run = inputs.run(&arguments);
            assert!(run.code() == 2 && run.stderr().contains(tip), "{}", run.stderr());
        }
    }
}

/// It was that of the tool, which takes no such options.
#[test]
fn the_usage_told_is_that_of_the_command() {
    let inputs = Inputs::new();
    for (command, more) in [
        ("query floor.pcd box.obj", "--seed=3"),
        ("query floor.pcd box.obj", "--min-range=5 --max-range=1"),
        ("path floor.pcd box.obj --poses=p.csv", "--min-range=5 --max-range=1"),
        ("scene s.json", "--min-range=5 --max-range=1"),
        ("robot floor.pcd r.urdf --joints=j.json", "--min-range=5 --max-range=1"),
        ("batch cases.json", "--pooling=max"),
    ] {
        let arguments: Vec<&str> = command.split(' ').chain(more.split(' ')).collect();
        let run = inputs.run(&arguments);
        let usage = format!("Usage: cloudtouch {} ", arguments[0]);
        assert!(run.code() == 2 && run.stderr().contains(&usage), "{}", run.stderr());
    }
}

/// A negative one was taken for an option, or made links thinner than they are.
#[test]
fn a_padding_below_zero_was_taken() {
    let inputs = Inputs::new();
    let robot = ["robot", "floor.pcd", "r.urdf", "--joints=j.json", "--scan-joints=j.json"];
    for padding in [&["--padding", "-1"][..], &["--padding=-0.02"]] {
        let run = inputs.run(&[&robot, padding].concat());
        assert_eq!(run.code(), 2, "{}", run.stderr());
        assert!(run.stderr().contains("0 or more"), "{}", run.stderr());
    }
}

#[test]
fn outputs_that_cannot_be_written() {
    let inputs = Inputs::new();
    let ply = ["query", "floor.pcd", "box.obj", "--ply", "gone/out.ply"];
    check(&inputs, &ply, &["gone/out.ply: cannot be written"]);
    check(&inputs, &["demo", "--ply", "gone/out.ply"], &["gone/out.ply: cannot be written"]);
    let case = support::case_at("a", 0.5);
    inputs.write("cases.json", &support::case_file(&[case]));
    let jsonl = ["batch", "cases.json", "--jsonl", "gone/out.jsonl"];
    check(&inputs, &jsonl, &["gone/out.jsonl: cannot be written"]);
}

/// It was written all the same, and no program that goes by names could open it.
#[test]
fn a_page_and_a_picture_were_written_under_any_name() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &support::case_file(&[support::case_at("a", 0.5)]));
    inputs.write("path.csv", "0,0,0.5,1,0,0,0\n0,0,0.3,1,0,0,0\n");
    std::fs::create_dir(inputs.path("a.b")).unwrap();
    let before = inputs.names();
    for (arguments, parts) in [
        (
            &["query", "floor.pcd", "box.obj", "--ply", "o.stl"][..],
            ["o.stl: is written as PLY", "name it o.ply"],
        ),
        (
            &["query", "floor.pcd", "box.obj", "--html", "o.ply"],
            ["o.ply: is written as HTML", "name it o.html"],
        ),
        (
            &["batch", "cases.json", "--html", "a.b/o.txt"],
            ["a.b/o.txt: is written", "name it a.b/o.html"],
        ),
        (
            &["path", "floor.pcd", "box.obj", "--poses=path.csv", "--html=o.htm"],
            ["o.htm: ", "o.html"],
        ),
        (&["demo", "--ply", "o.pcd"], ["o.pcd: ", "name it o.ply"]),
        (&["demo", "--html", "o.pdf"], ["o.pdf: ", "name it o.html"]),
    ] {
        let run = inputs.run(arguments);
        assert_eq!((run.code(), run.stdout().as_str()), (2, ""), "{arguments:?}");
        for part in parts {
            assert!(run.stderr().contains(part), "`{part}` is not in {}", run.stderr());
        }
        assert_eq!(inputs.names(), before, "{arguments:?} left something behind");
    }
    inputs.run(&["query", "floor.pcd", "box.obj", "--ply=O.PLY", "--html=O.HTML"]).quiet(0);
    inputs.run(&["query", "floor.pcd", "box.obj", "--ply=picture"]).quiet(0);
}

/// It was told when all the work was done.
#[test]
fn a_folder_that_is_not_there_was_told_after_hours_of_work() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &support::case_file(&[support::case_at("a", 0.5)]));
    inputs.write("path.csv", "0,0,0.5,1,0,0,0\n0,0,0.3,1,0,0,0\n");
    std::fs::create_dir(inputs.path("folder")).unwrap();
    for command in [
        &["query", "floor.pcd", "box.obj"][..],
        &["batch", "cases.json"],
        &["path", "floor.pcd", "box.obj", "--poses=path.csv"],
        &["demo"],
    ] {
        let to = |output| [command, &["--force", "--html", output]].concat();
        check(
            &inputs,
            &to("gone/o.html"),
            &["gone/o.html: cannot be written", "no folder `gone`", "make it"],
        );
        check(&inputs, &to("new/"), &["new/: cannot be written", "no folder `new/`"]);
        check(&inputs, &to("folder"), &["folder: cannot be written", "is a folder", "file in it"]);
        check(
            &inputs,
            &to("box.obj/o.html"),
            &["box.obj/o.html: cannot be written", "no folder `box.obj`"],
        );
    }
}

/// A file of that name was made, and nothing came out.
#[test]
fn standard_output_in_place_of_a_file_was_a_file_called_so() {
    let inputs = Inputs::new();
    inputs.write("cases.json", &support::case_file(&[support::case_at("a", 0.5)]));
    inputs.write("path.csv", "0,0,0.5,1,0,0,0\n0,0,0.3,1,0,0,0\n");
    for arguments in [
        &["query", "floor.pcd", "box.obj", "--csv", "-"][..],
        &["query", "floor.pcd", "box.obj", "--ply=-", "--force"],
        &["batch", "cases.json", "--jsonl", "-"],
        &["batch", "cases.json", "--html=-"],
        &["path", "floor.pcd", "box.obj", "--poses=path.csv", "--html=-"],
        &["demo", "--html", "-"],
    ] {
        check(&inputs, arguments, &["-: ", "standard output", "name a file"]);
    }
}

/// Its extension was said to be "" and the file to be renamed.
#[cfg(unix)]
#[test]
fn a_pipe_was_asked_for_its_extension() {
    let inputs = Inputs::new();
    for pipe in ["/dev/stdin", "/dev/null"] {
        check(&inputs, &["query", pipe, "box.obj"], &[pipe, "is no file", "such as scan.pcd"]);
        check(&inputs, &["info", pipe], &[pipe, "is no file", "such as scan.pcd"]);
    }
}

#[test]
fn a_failed_query_leaves_an_old_picture_alone() {
    let inputs = Inputs::new();
    inputs.write("out.ply", "old");
    check(&inputs, &["query", "gone.pcd", "box.obj", "--ply", "out.ply"], &["gone.pcd"]);
    assert_eq!(std::fs::read_to_string(inputs.path("out.ply")).unwrap(), "old");
}
