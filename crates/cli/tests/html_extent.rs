//! A report page of things far larger or smaller than one another: the object is in the picture. Skipped, with the
//! reason, where no Chromium is found.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use base64::Engine as _;
use serde_json::json;

use crate::support::browser::{Tab, chromium, corner};
use crate::support::{Inputs, case_at, case_file, cube, floor};

const SIZE: [u32; 2] = [1000, 700];

/// Blue pixels of the picture, which are those of the object.
fn blue(tab: &mut Tab, inputs: &Inputs) -> usize {
    tab.settle();
    let shot = tab.ask("Page.captureScreenshot", json!({"format": "png"}));
    let bytes = base64::engine::general_purpose::STANDARD.decode(shot["data"].as_str().unwrap());
    std::fs::write(inputs.path("shot.png"), bytes.unwrap()).unwrap();
    // Without the buttons above, and the legend below.
    let seen = corner(&inputs.path("shot.png"), [590, 590]);
    seen[590 * 50..].iter().filter(|[r, _, b]| *b > r + 60).count()
}

/// Chooses another scene and object.
fn choose(tab: &mut Tab, place: u32) {
    tab.value(&format!(
        "(() => {{ const pairs = document.querySelector('select'); pairs.selectedIndex = {place};
           pairs.dispatchEvent(new Event('change')); }})()"
    ));
}

/// The picture was empty: it began farther away than the object.
#[test]
fn a_point_at_the_origin_of_a_map_hid_all_that_was_asked_about() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    let [x, y, z] = [500_000.0, 5_400_000.0, 300.0];
    let placed =
        floor().points.into_iter().map(|p| format!("{} {} {}\n", p.x + x, p.y + y, p.z + z));
    let rows: String = placed.chain(["0.5 0.5 0.5\n".to_owned()]).collect();
    inputs.write("map.xyz", &rows);
    let translate = format!("--translate={x},{y},{}", z + 0.2);
    let arguments =
        ["query", "map.xyz", "box.obj", "--sensor=iso:0.002", &translate, "--html=o.html"];
    assert_eq!(inputs.run(&arguments).code(), 0);
    let mut tab = Tab::open(&browser, &inputs.path("o.html"), SIZE, false);
    let seen = blue(&mut tab, &inputs);
    assert!(seen > 20_000, "{seen}");
}

/// The camera stood in the point, and no button brought it out again.
#[test]
fn an_object_that_is_one_point_was_not_to_be_seen_and_held_the_camera() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    inputs.write("one.xyz", "0 0 0\n");
    let translate = "--translate=0.01,0.02,0.1";
    let sensors = ["--sensor=iso:0.002", "--object-sensor=exact"];
    let arguments = [&["query", "floor.pcd", "one.xyz", translate, "--html=o.html"][..], &sensors];
    assert_eq!(inputs.run(&arguments.concat()).code(), 0);
    let mut tab = Tab::open(&browser, &inputs.path("o.html"), SIZE, false);
    let seen = blue(&mut tab, &inputs);
    assert!((5..200).contains(&seen), "{seen}");
    let bar = "document.querySelector('.bar').textContent";
    let near = tab.value(bar);
    tab.value("document.querySelectorAll('.buttons button')[3].click()");
    tab.settle();
    assert_ne!(tab.value(bar), near, "the whole scene is as near");
}

/// The camera stayed as far away as the scene before was large.
#[test]
fn a_small_scene_chosen_after_a_large_one_was_a_speck() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    let rows: String =
        floor().points.iter().map(|p| format!("{} {} {}\n", 30.0 * p.x, 30.0 * p.y, p.z)).collect();
    inputs.write("hall.xyz", &rows);
    cloudtouch_io::write_mesh_obj(inputs.path("lorry.obj"), &cube(3.0)).unwrap();
    let hall =
        case_at("hall", 5.0).replace("floor.pcd", "hall.xyz").replace("box.obj", "lorry.obj");
    inputs.write("cases.json", &case_file(&[hall, case_at("small", 0.5)]));
    inputs.run(&["batch", "cases.json", "--html=o.html"]).quiet(0);
    let mut tab = Tab::open(&browser, &inputs.path("o.html"), SIZE, false);
    let first = blue(&mut tab, &inputs);
    choose(&mut tab, 1);
    let second = blue(&mut tab, &inputs);
    assert!(first > 20_000 && second > 20_000, "{first} {second}");
}

/// Only a page that was opened anew went to the pose in its address.
#[test]
fn a_pose_named_in_the_address_of_an_open_page_is_shown() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    inputs.write("cases.json", &case_file(&[case_at("apart", 0.5), case_at("touching", 0.09)]));
    inputs.run(&["batch", "cases.json", "--html=o.html"]).quiet(0);
    let mut tab = Tab::open(&browser, &inputs.path("o.html"), SIZE, false);
    let shown = "document.querySelector('section.answer:not([hidden])').id";
    assert_eq!(tab.value(shown), "answer-0");
    for (address, wanted) in [("#2", "answer-1"), ("#7", "answer-1"), ("#1", "answer-0")] {
        tab.value(&format!("location.hash = '{address}'"));
        tab.settle();
        assert_eq!(tab.value(shown), wanted, "{address}");
    }
}

/// In windows of 761 to some 910 pixels the bar lay over the words of the legend.
#[test]
fn the_scale_bar_lay_over_the_legend_of_a_window_that_is_half_a_screen_wide() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    inputs.query_at(0.5, &["--html=o.html"]).quiet(0);
    let edges = "(() => {
        document.querySelector('.bar').style.width = '120px';
        return ['.bar', '#legend', '.axes'].map((name) => {
          const { left, right, top, bottom } = document.querySelector(name).getBoundingClientRect();
          return [left, right, top, bottom]; }); })()";
    for width in [762, 800, 860, 910, 955, 965, 1100] {
        let mut tab = Tab::open(&browser, &inputs.path("o.html"), [width, 700], false);
        let boxes: Vec<[f64; 4]> = serde_json::from_value(tab.value(edges)).unwrap();
        for (i, [left, right, top, bottom]) in boxes.iter().enumerate() {
            for other in &boxes[i + 1..] {
                let is_apart =
                    [left >= &other[1], right <= &other[0], top >= &other[3], bottom <= &other[2]];
                assert!(is_apart.contains(&true), "{width}: {boxes:?}");
            }
        }
    }
}
