//! Files that are no description of a robot, or two in one.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::Arm;

const LINK: &str =
    "<link name='a'><collision><geometry><sphere radius='1'/></geometry></collision></link>";

/// They were told to lack `<collision>`.
#[test]
fn what_is_no_urdf_is_told_what_it_is() {
    let arm = Arm::default();
    let of_links = format!("<model>{LINK}</model>");
    for (text, parts) in [
        (
            "<?xml version='1.0'?><sdf version='1.9'><model name='m'/></sdf>",
            ["an SDF", "root is <sdf>"],
        ),
        ("<!DOCTYPE html><html lang=en><body><p>404<br></body>", ["a web page", "download"]),
        ("<HTML><body></body></HTML>", ["a web page", "<HTML>"]),
        ("<mujoco model='m'><worldbody/></mujoco>", ["MuJoCo", "convert it"]),
        // Here "No elements found" was all.
        ("v 0 0 0\nv 1 0 0\n", ["there is no <robot> in it", "give the URDF"]),
        ("<COLLADA/>", ["a mesh (COLLADA)", "give the file that names it"]),
        // It was read.
        (&of_links, ["no description of a robot", "root is <model>"]),
        (
            "<robot name='r'><group name='g'><link name='a'/></group></robot>",
            ["is an SRDF", "give the URDF"],
        ),
    ] {
        let error = arm.of(text).unwrap_err().to_string();
        for part in parts.iter().chain(&["arm.urdf: "]) {
            assert!(error.contains(part), "{part:?} in {error}");
        }
    }
}

/// What came after the first was not there, and read as free.
#[test]
fn a_second_root_was_passed_over() {
    let arm = Arm::default();
    let second = format!("<robot name='r'>{LINK}</robot>");
    let error = arm.of(&format!("{second}\n{second}")).unwrap_err().to_string();
    assert!(error.contains("a second root, <robot>") && error.contains("in one"), "{error}");
    assert!(arm.of(&format!("<!-- by hand -->{second}<!-- end -->\n")).is_ok());
}

/// It let no pair touch, without a word.
#[test]
fn what_is_no_srdf_is_told_what_it_is() {
    let arm = Arm::default();
    let pair = "<disable_collisions link1='base' link2='hand'/>";
    for (text, told) in [
        (
            "<html><body/></html>".to_owned(),
            "is a web page: its root is <html>, and that of an SRDF",
        ),
        (format!("<sdf>{pair}</sdf>"), "is an SDF"),
        (format!("<semantics>{pair}</semantics>"), "give the SRDF of the robot"),
        (format!("<robot>{pair}</robot><robot>{pair}</robot>"), "a second root"),
    ] {
        let srdf = arm.path("other.srdf");
        std::fs::write(&srdf, text).unwrap();
        let error = arm.robot().with_srdf(srdf).unwrap_err().to_string();
        assert!(error.contains("other.srdf") && error.contains(told), "{error}");
    }
}
