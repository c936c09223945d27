//! A report page under a hand: a drag turns the picture, the wheel and two fingers bring it nearer. Skipped, with the
//! reason, where no Chromium is found.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use crate::support::browser::{Tab, chromium};
use crate::support::{Inputs, case_at, case_file};
use serde_json::{Value, json};

/// Which way the axes point, and how long the scale bar and what it stands for are: what the page shows of its camera.
fn view(tab: &mut Tab) -> (Value, f64) {
    tab.settle();
    let axes = tab.value(
        "[...document.querySelectorAll('.axes line')].flatMap((line) => ['x2', 'y2'].map(
           (end) => Math.round(100 * line.getAttribute(end))))",
    );
    let bar = tab.value(
        "(() => { const bar = document.querySelector('.bar'); const [many, unit] = bar.textContent.split(' ');
           return bar.getBoundingClientRect().width / Number(many) / { mm: 1e-3, cm: 1e-2, m: 1, km: 1e3 }[unit]; })()",
    );
    (axes, bar.as_f64().unwrap())
}

fn touch(tab: &mut Tab, kind: &str, fingers: &[[i32; 2]]) {
    let at = |(id, [x, y]): (usize, &[i32; 2])| json!({"x": x, "y": y, "id": id});
    let points: Vec<Value> = fingers.iter().enumerate().map(at).collect();
    tab.ask("Input.dispatchTouchEvent", json!({"type": kind, "touchPoints": points}));
}

fn page(inputs: &Inputs) -> std::path::PathBuf {
    inputs.write("cases.json", &case_file(&[case_at("apart", 0.5), case_at("touching", 0.09)]));
    inputs.run(&["batch", "cases.json", "--html=o.html"]).quiet(0);
    inputs.path("o.html")
}

#[test]
fn a_mouse_turns_the_picture_and_its_wheel_brings_it_nearer() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    let mut tab = Tab::open(&browser, &page(&inputs), [1000, 700], false);
    let (axes, pixels_per_metre) = view(&mut tab);
    let mut mouse = |kind: &str, [x, y]: [i32; 2], more: Value| {
        let mut event = json!({"type": kind, "x": x, "y": y, "button": "left", "clickCount": 1});
        event.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        tab.ask("Input.dispatchMouseEvent", event);
    };
    mouse("mousePressed", [200, 300], json!({}));
    mouse("mouseMoved", [260, 320], json!({"buttons": 1}));
    mouse("mouseMoved", [320, 340], json!({"buttons": 1}));
    mouse("mouseReleased", [320, 340], json!({}));
    let (turned, same) = view(&mut tab);
    assert_ne!(turned, axes, "the drag did not turn it");
    assert!((same / pixels_per_metre - 1.0).abs() < 0.02, "{same} for {pixels_per_metre}");
    let wheel = json!({"type": "mouseWheel", "x": 200, "y": 300, "deltaX": 0, "deltaY": -600});
    tab.ask("Input.dispatchMouseEvent", wheel);
    let (still, nearer) = view(&mut tab);
    assert_eq!(still, turned);
    assert!(nearer > 1.2 * pixels_per_metre, "{nearer} for {pixels_per_metre}");
}

#[test]
fn on_a_phone_a_finger_turns_two_come_nearer_and_nothing_is_wider_than_the_screen() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    let mut tab = Tab::open(&browser, &page(&inputs), [390, 844], true);
    assert_eq!(tab.value("document.documentElement.scrollWidth"), 390);
    // Buttons for a finger, text that is read without a glass, and room to scroll beside the picture.
    let least = |name: &str, what: &str| {
        format!("Math.min(...[...document.querySelectorAll('{name}')].map((e) => {what}))")
    };
    let height = tab.value(&least(".buttons button", "e.getBoundingClientRect().height"));
    assert!(height.as_f64().unwrap() > 36.0, "{height}");
    let letters = "parseFloat(getComputedStyle(e).fontSize)";
    let size = tab.value(&least("aside *:not(pre):not(script), .buttons *, #legend *", letters));
    assert!(size.as_f64().unwrap() >= 11.5, "{size}");
    let below = tab.value("document.querySelector('aside').getBoundingClientRect().top");
    assert!(below.as_f64().unwrap() < 0.7 * 844.0, "{below}");
    // The scale bar, as long as it gets, the legend and the axes lie beside or above one another.
    let edges = "(() => {
        const bar = document.querySelector('.bar'), width = bar.style.width;
        bar.style.width = '120px';
        const boxes = ['.bar', '#legend', '.axes', '#picture'].map((name) => {
          const { left, right, top, bottom } = document.querySelector(name).getBoundingClientRect();
          return [left, right, top, bottom]; });
        bar.style.width = width;
        return boxes; })()";
    let boxes: Vec<[f64; 4]> = serde_json::from_value(tab.value(edges)).unwrap();
    for (i, [left, right, top, bottom]) in boxes[..3].iter().enumerate() {
        assert!(*left >= 0.0 && *right <= 390.0 && *bottom <= boxes[3][3], "{boxes:?}");
        for other in &boxes[i + 1..3] {
            let is_apart =
                [left >= &other[1], right <= &other[0], top >= &other[3], bottom <= &other[2]];
            assert!(is_apart.contains(&true), "{boxes:?}");
        }
    }
    let (axes, pixels_per_metre) = view(&mut tab);
    touch(&mut tab, "touchStart", &[[150, 250]]);
    touch(&mut tab, "touchMove", &[[190, 260]]);
    touch(&mut tab, "touchMove", &[[230, 270]]);
    touch(&mut tab, "touchEnd", &[]);
    let (turned, same) = view(&mut tab);
    assert_ne!(turned, axes, "the finger did not turn it");
    assert!((same / pixels_per_metre - 1.0).abs() < 0.02, "{same} for {pixels_per_metre}");
    touch(&mut tab, "touchStart", &[[170, 250], [210, 250]]);
    touch(&mut tab, "touchMove", &[[140, 250], [240, 250]]);
    touch(&mut tab, "touchMove", &[[110, 250], [270, 250]]);
    touch(&mut tab, "touchEnd", &[]);
    let (_, nearer) = view(&mut tab);
    assert!(nearer > 1.5 * pixels_per_metre, "{nearer} for {pixels_per_metre}");
    // Pixels and not the page: it is the picture that came nearer.
    assert_eq!(tab.value("window.visualViewport.scale"), 1);
}

#[test]
fn each_scene_of_a_batch_is_shown_as_it_was_seen() {
    let Some(browser) = chromium() else {
        return println!("skipped: no Chromium is found; CHROMIUM names one");
    };
    let inputs = Inputs::new();
    // A wall 2 m before a camera, beside the floor.
    let rows = (0..400).map(|i| (0.05 * f64::from(i % 20), 0.05 * f64::from(i / 20)));
    let rows: String = rows.map(|(x, y)| format!("{} {} 2\n", x - 0.5, y - 0.5)).collect();
    inputs.write("wall.xyz", &rows);
    let wall = case_at("wall", 1.5).replace("floor.pcd", "wall.xyz");
    inputs.write("cases.json", &case_file(&[case_at("apart", 0.5), wall, case_at("near", 0.12)]));
    inputs.run(&["batch", "cases.json", "--html=o.html"]).quiet(0);
    let mut tab = Tab::open(&browser, &inputs.path("o.html"), [1000, 700], false);
    let turned = "document.querySelector('.buttons button:last-child').textContent";
    let pair = |tab: &mut Tab, place: u32| {
        let choose = format!(
            "(() => {{ const pairs = document.querySelector('select'); pairs.selectedIndex = {place};
               pairs.dispatchEvent(new Event('change')); return pairs.value; }})()"
        );
        tab.value(&choose);
        view(tab).0
    };
    let (floor, words) = (view(&mut tab).0, tab.value(turned));
    assert_eq!(words, "z is up");
    let wall = pair(&mut tab, 1);
    assert_eq!(tab.value(turned), "as the camera saw it");
    assert_ne!(wall, floor);
    // A turn by the button stays with its scene.
    tab.value("document.querySelector('.buttons button:last-child').click()");
    assert_eq!(tab.value(turned), "z is up");
    assert_eq!((pair(&mut tab, 0), tab.value(turned)), (floor, "z is up".into()));
    pair(&mut tab, 1);
    assert_eq!(tab.value(turned), "z is up");
}
