//! What `--help` of a command lists is what the command takes.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::Inputs;

/// Options that these commands refuse whatever else is given.
const EVERYWHERE: [&str; 5] =
    ["--mode=paper", "--pooling=max", "--seed=1", "--settings=s.toml", "--margin=0.1"];
/// ... and what each of them refuses besides.
const REFUSED: [(&str, &[&str]); 3] = [
    ("path floor.pcd box.obj --poses=p.csv", &[]),
    (
        "scene scene.json",
        &[
            "--object-sensor=kinect",
            "--sensor-pose=0,0,1",
            "--collision-map=0.1",
            "--robot=box.obj",
        ],
    ),
    ("robot floor.pcd r.urdf --joints=j.json", &["--object-sensor=kinect", "--robot=box.obj"]),
];

/// They were listed, and whoever gave one was told to leave it out, or to give another that is refused too.
#[test]
fn an_option_that_is_refused_was_listed() {
    let inputs = Inputs::new();
    inputs.write("s.toml", "");
    for (command, options) in REFUSED {
        let words: Vec<&str> = command.split(' ').collect();
        let help = inputs.run(&[words[0], "--help"]).quiet(0).stdout();
        for option in EVERYWHERE.iter().chain(options) {
            let run = inputs.run(&[&words[..], &[option]].concat());
            let error = run.stderr();
            let name = option.split('=').next().unwrap();
            assert!(run.code() == 2 && error.contains(name), "{command} {option}: {error}");
            let is_told = ["leave it out", &format!("leave {name} out"), "--scan-joints"];
            assert!(is_told.iter().any(|part| error.contains(part)), "{error}");
            assert!(!error.contains("give --mode paper"), "{command} {option}: {error}");
            assert!(!help.contains(&format!(" {name} ")), "{command}: {name} is listed");
        }
        assert_eq!(help.contains("--robot-padding"), help.contains("--robot "), "{command}");
    }
}

/// They stood in the help of single commands, and the verdict was said to be told by `query` alone.
#[test]
fn exit_codes_of_verdicts_were_not_named() {
    let help = Inputs::new().run(&["--help"]).quiet(0).stdout();
    let words = help.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in ["query, path, scene and robot", "10 uncertain", "20 in collision", "30 undecided"]
    {
        assert!(words.contains(part), "`{part}` is not in {help}");
    }
}

/// The format stood in a file of the repository that no help named.
#[test]
fn the_help_of_scene_did_not_say_what_a_scene_file_holds() {
    let help = Inputs::new().run(&["scene", "--help"]).quiet(0).stdout();
    for part in ["\"bodies\"", "\"attached_to\"", "\"allowed\"", "docs/scenes.md"] {
        assert!(help.contains(part), "`{part}` is not in {help}");
    }
}

#[test]
fn options_that_need_another_did_not_say_so() {
    let inputs = Inputs::new();
    for (command, option, needed) in [
        ("query", "--robot-padding", "--robot"),
        ("query", "--points", "--json"),
        ("query", "--explain", "--json"),
        ("path", "--force", "--html"),
        ("robot", "--padding", "--scan-joints"),
        ("robot", "--srdf", "--self-collision"),
    ] {
        let help = inputs.run(&[command, "--help"]).quiet(0).stdout();
        let line = help.lines().find(|line| line.contains(&format!(" {option}"))).unwrap();
        let words = line.split(option).nth(1).unwrap();
        assert!(words.contains(&format!("ith {needed}")), "{command}: {line}");
    }
}

/// It was said to stop each query, also of commands that it stops as a whole, and to leave it undecided at worst.
#[test]
fn the_help_of_a_deadline_did_not_say_what_it_ends() {
    let inputs = Inputs::new();
    for command in ["query", "batch", "path", "scene", "robot"] {
        let help = inputs.run(&[command, "--help"]).quiet(0).stdout();
        let line = help.lines().find(|line| line.contains("--deadline")).unwrap();
        let parts = ["query", "whole path, scene or robot", "none is free"];
        assert!(parts.iter().all(|part| line.contains(part)), "{command}: {line}");
        assert!(line.len() <= 100, "{command}: {line}");
    }
}

/// It replaced nothing and said nothing, where other commands refuse it.
#[test]
fn force_without_a_file_to_write_is_refused() {
    let inputs = Inputs::new();
    for arguments in [&["query", "floor.pcd", "box.obj"][..], &["batch", "cases.json"], &["demo"]] {
        let run = inputs.run(&[arguments, &["--force"]].concat());
        assert_eq!((run.code(), run.stdout().as_str()), (2, ""), "{}", run.stderr());
        assert!(run.stderr().contains("--html"), "{}", run.stderr());
    }
}
