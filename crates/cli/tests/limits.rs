//! Limits on what is read: the error names the file, what was found and the limit.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::Inputs;

fn check(inputs: &Inputs, arguments: &[&str], parts: &[&str]) {
    let run = inputs.run(arguments);
    let error = run.stderr();
    assert_eq!((run.code(), run.stdout().as_str()), (1, ""), "{arguments:?}: {error}");
    for part in parts {
        assert!(error.contains(part), "`{part}` is not in: {error}");
    }
}

#[test]
fn a_header_that_promises_10_to_the_12_points_ends_in_an_error() {
    let inputs = Inputs::new();
    let header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1000000000000\nDATA";
    inputs.write("binary.pcd", &format!("{header} binary\n"));
    inputs.write("ascii.pcd", &format!("{header} ascii\n1 2 3\n"));
    for file in ["binary.pcd", "ascii.pcd"] {
        check(&inputs, &["info", file], &[file, "promises 1000000000000 rows"]);
    }
}

#[test]
fn each_limit_can_be_set() {
    let inputs = Inputs::new();
    let limits = ["--max-points=440", "--max-triangles=11", "--max-bytes=30"];
    for (limit, file, parts) in [
        (
            limits[0],
            "floor.pcd",
            &["floor.pcd", "441 points", "440", "limit on points (--max-points)"][..],
        ),
        (
            limits[1],
            "box.obj",
            &["box.obj", "12 triangles", "11", "limit on triangles (--max-triangles)"],
        ),
        (
            limits[2],
            "floor.pcd",
            &["floor.pcd", "more than 30 bytes", "limit on bytes (--max-bytes)"],
        ),
    ] {
        check(&inputs, &["info", file, limit], parts);
        check(&inputs, &["query", "floor.pcd", "box.obj", limit], parts);
    }
    check(&inputs, &["batch", "floor.pcd", limits[2]], &["floor.pcd", "more than 30 bytes"]);
    assert_eq!(inputs.run(&["info", "floor.pcd", "--max-points=441"]).code(), 0);
}

#[test]
fn a_count_that_is_no_whole_number_was_an_invalid_digit_found_in_string() {
    let inputs = Inputs::new();
    for option in
        ["--max-points=1e6", "--max-bytes=-1", "--seed=1.5", "--seed=18446744073709551616"]
    {
        let run = inputs.query_at(0.2, &["--mode=paper", option]);
        assert_eq!(run.code(), 2, "{option}");
        assert!(run.stderr().contains("give a whole number"), "{option}: {}", run.stderr());
    }
}

/// They were read whole, however large: a device filled all memory.
#[test]
fn poses_and_kappas_are_files_with_a_limit_too() {
    let inputs = Inputs::new();
    let long = "# a comment\n".repeat(10_000);
    inputs.write("long.txt", &long);
    let limit = "--max-bytes=100000";
    let parts = &["long.txt", "more than 100000 bytes", "(--max-bytes)"];
    let pair = ["floor.pcd", "box.obj", limit];
    for (command, more) in [
        ("query", &["--pose=long.txt"][..]),
        ("query", &["--mode=paper", "--kappas=long.txt"]),
        ("path", &["--poses=long.txt"]),
    ] {
        check(&inputs, &[&[command], &pair[..], more].concat(), parts);
    }
}
