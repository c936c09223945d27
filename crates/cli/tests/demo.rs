//! `cloudtouch demo`: runs without any file, in a hundred columns, and is honest about errors.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::Inputs;

#[test]
fn shows_twelve_poses_and_one_in_full() {
    let inputs = Inputs::new();
    let before = inputs.names();
    let text = inputs.run(&["demo"]).quiet(0).stdout();
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    let row = |line: &&str| line.contains(" apart ") || line.contains(" overlap ");
    assert_eq!(text.lines().filter(row).count(), 12, "{text}");
    for expected in ["29576 points", "9000 points", "in full", "collision probability"] {
        assert!(text.contains(expected), "{text}");
    }
    // 25 cm apart leaves no doubt, and neither does an overlap of 5 to 12 cm.
    let rows: Vec<&str> = text.lines().filter(row).collect();
    let certain = rows[8..].iter().filter(|row| row.contains("in collision")).count();
    assert!(rows[0].contains("free") && certain == 4, "{text}");
    assert!(rows[6..].iter().all(|row| !row.contains("free")), "{text}");
    assert_eq!(inputs.names(), before);
}

/// What is printed of a fit that changed is old.
#[test]
fn the_readme_shows_what_it_prints() {
    // Times are of the machine.
    let timeless = |text: &str| -> Vec<String> {
        let line = |line: &str| match line.strip_suffix(" ms").and_then(|l| l.rsplit_once(' ')) {
            Some((answer, _)) => answer.trim_end().to_owned(),
            None => line.to_owned(),
        };
        text.trim_end().lines().map(line).collect()
    };
    let readme = include_str!("../README.md");
    let (_, shown) = readme.split_once("$ cloudtouch demo\n").unwrap();
    let (shown, _) = shown.split_once("```").unwrap();
    let printed = Inputs::new().run(&["demo"]).quiet(0).stdout();
    assert_eq!(timeless(shown), timeless(&printed));
}

/// The table of a batch was of a fit before the last.
#[test]
fn the_readme_shows_what_a_batch_prints() {
    let rows = |text: &str| -> Vec<String> {
        // Times are of the machine.
        let row = |line: &str| {
            let (answer, bodies) = line.split_once(" ms ")?;
            let (answer, _) = answer.trim_end().rsplit_once(' ')?;
            let words = answer.split_whitespace().chain(bodies.split_whitespace());
            Some(words.collect::<Vec<_>>().join(" "))
        };
        text.lines().filter(|line| line.starts_with("piano-room-")).filter_map(row).collect()
    };
    let readme = include_str!("../README.md");
    let (_, shown) = readme.split_once("$ cloudtouch batch cases.json\n").unwrap();
    let (shown, _) = shown.split_once("```").unwrap();
    let cases = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/piano-room/cases.json");
    let printed = Inputs::new().run(&["batch", cases]).quiet(0).stdout();
    assert_eq!(rows(shown), rows(&printed));
    assert_eq!(rows(shown).len(), 12);
}

#[test]
fn paints_the_pose_it_shows() {
    let inputs = Inputs::new();
    let text = inputs.run(&["demo", "--ply", "demo.ply"]).quiet(0).stdout();
    assert!(text.contains("demo.ply"), "{text}");
    let picture = cloudtouch_io::read_cloud(inputs.path("demo.ply")).unwrap();
    assert!(picture.points.len() >= 29576 + 9000, "{} points", picture.points.len());
}

#[test]
fn its_page_shows_all_poses_and_what_is_true_of_them() {
    let inputs = Inputs::new();
    let run = ["demo", "--html", "demo.html"];
    assert!(inputs.run(&run).quiet(0).stdout().contains("demo.html"));
    let page = std::fs::read_to_string(inputs.path("demo.html")).unwrap();
    assert_eq!(page.matches("True of the meshes").count(), 12);
    for number in 0..12 {
        // The least certain of them is shown first.
        let hidden = format!("id=\"answer-{number}\" hidden");
        assert_eq!(page.contains(&hidden), number != 6, "{number}");
    }
    assert!(inputs.run(&run).stderr().contains("--force"));
}
