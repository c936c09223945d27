//! A report page in a browser: it draws, without a word in the console. Skipped, with the reason, where no Chromium
//! is found.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use crate::support::browser::{chromium, corner, open};
use crate::support::{Inputs, case_at, case_file};

#[test]
fn a_page_draws_scene_object_and_contact_and_shows_the_pose_in_its_address() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    let cases = [case_at("apart", 0.5), case_at("touching", 0.09)];
    inputs.write("cases.json", &case_file(&cases));
    inputs.run(&["batch", "cases.json", "--html=o.html"]).quiet(0);
    for (address, shown, hidden) in [("o.html", 0, 1), ("o.html#2", 1, 0)] {
        let seen = open(&browser, &inputs, address, &["--dump-dom"]);
        assert_eq!(seen.console, Vec::<String>::new());
        assert!(seen.elements.contains(&format!("id=\"answer-{shown}\">")), "{address}");
        assert!(seen.elements.contains(&format!("id=\"answer-{hidden}\" hidden")), "{address}");
        assert!(seen.elements.contains("<canvas"), "{address}");
        assert!(seen.elements.contains("type=\"range\""), "{address}");
    }
    // A desktop and a phone, each with the part of it that only the picture takes, without the legend.
    for (size, part) in [("1000,700", [590, 600]), ("500,900", [500, 420])] {
        let shots = ["o.html", "o.html#2"].map(|address| {
            let name = format!("{}.png", address.len());
            let screenshot = format!("--screenshot={}", inputs.path(&name).display());
            let size = format!("--window-size={size}");
            let seen = open(&browser, &inputs, address, &[&screenshot, &size]);
            assert_eq!(seen.console, Vec::<String>::new());
            corner(&inputs.path(&name), part)
        });
        let count = |shot: &[[i32; 3]], is: &dyn Fn([i32; 3]) -> bool| {
            shot.iter().filter(|pixel| is(**pixel)).count()
        };
        // The object is blue, the scene grey, what is likely between yellow and dark red.
        let is_blue = |[r, _, b]: [i32; 3]| b > r + 60;
        let is_grey = |[r, g, b]: [i32; 3]| (60..180).contains(&g) && (r - b).abs() < 40;
        let is_warm = |[r, g, b]: [i32; 3]| r > b + 30 && r > g + 60;
        for shot in &shots {
            assert!(count(shot, &is_blue) > 2000, "{size}: no object");
            assert!(count(shot, &is_grey) > 1000, "{size}: no scene");
        }
        let warm = shots.each_ref().map(|shot| count(shot, &is_warm));
        assert!(warm[0] == 0 && warm[1] > 300, "{size}: no contact, {warm:?}");
    }
}
