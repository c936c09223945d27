//! Pairs of bodies that may touch are not asked about, and who was in no other is named.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::sync::Arc;

use crate::common::at;
use crate::common::scenes::{mesh, query};
use cloudtouch::{Scene, Verdict};
use cloudtouch_testkit::scene;

/// It read as free, though nothing was checked.
#[test]
fn a_scene_in_which_all_may_touch_is_undecided() {
    let mut scene = Scene::default();
    assert_eq!(scene.check(&query()).verdict(), Verdict::Undecided);
    let cube = Arc::new(mesh(&scene::cuboid([0.1; 3])));
    scene.add("hand", Arc::clone(&cube), at(0.0, 0.0, 0.0)).unwrap();
    assert_eq!(scene.check(&query()).verdict(), Verdict::Undecided);
    scene.add("cup", cube, at(0.5, 0.0, 0.0)).unwrap();
    assert_eq!(scene.check(&query()).verdict(), Verdict::Free);
    scene.allow("hand", "cup").unwrap();
    let found = scene.check(&query());
    assert!(found.is_unchecked() && found.pairs.is_empty());
    assert!(!scene.is_free(&query()));
    assert_eq!(found.verdict(), Verdict::Undecided);
    scene.forbid("hand", "cup").unwrap();
    assert_eq!(scene.check(&query()).verdict(), Verdict::Free);
}

/// A scan that all may touch was in no pair, and the scene read as free without a word of it.
#[test]
fn a_body_of_which_no_pair_was_checked_is_named() {
    let cube = Arc::new(mesh(&scene::cuboid([0.1; 3])));
    let mut scene = Scene::default();
    for (name, x) in [("cup", 0.0), ("hand", 1.0), ("scan", 0.0)] {
        scene.add(name, Arc::clone(&cube), at(x, 0.0, 0.0)).unwrap();
    }
    let unchecked = |scene: &Scene| scene.check(&query()).unchecked;
    assert!(unchecked(&scene).is_empty());
    scene.allow("scan", "cup").unwrap();
    assert!(unchecked(&scene).is_empty());
    scene.allow("hand", "scan").unwrap();
    let found = scene.check(&query());
    assert_eq!((found.verdict(), &found.unchecked[..]), (Verdict::Free, &["scan".to_owned()][..]));
    assert!(!found.is_unchecked());
    scene.allow("hand", "cup").unwrap();
    assert_eq!(unchecked(&scene), ["cup", "hand", "scan"]);
    scene.forbid("scan", "cup").unwrap();
    assert_eq!(unchecked(&scene), ["hand"]);
}
