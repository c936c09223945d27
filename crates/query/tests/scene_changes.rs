//! Bodies are added, moved, attached, changed and removed; what cannot be meant is refused.

#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::sync::Arc;

use crate::common::scenes::{cloud, mesh, names, query};
use crate::common::{at, measured};
use cloudtouch::geom::PointCloud;
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, CloudSettings, Scene, SceneError, Verdict};
use cloudtouch_testkit::scene;

#[test]
fn what_is_attached_moves_along_and_stays_when_let_go() {
    let cube = Arc::new(mesh(&scene::cuboid([0.1; 3])));
    let mut scene = Scene::default();
    scene.add("hand", Arc::clone(&cube), at(0.0, 0.0, 0.0)).unwrap();
    scene.add("cup", Arc::clone(&cube), at(0.5, 0.0, 0.0)).unwrap();
    scene.add("wall", cube, at(2.0, 0.0, 0.0)).unwrap();
    let grasp = scene.between("hand", "cup").unwrap();
    scene.attach("cup", "hand", grasp).unwrap();
    assert!(scene.check(&query()).pairs.is_empty());
    scene.set_pose("hand", at(1.55, 0.0, 0.0)).unwrap();
    let found = scene.check(&query());
    assert_eq!((names(&found), found.verdict()), (vec![["cup", "wall"]], Verdict::InCollision));
    scene.detach("cup").unwrap();
    scene.set_pose("hand", at(0.0, 0.0, 0.0)).unwrap();
    assert!((scene.pose("cup").unwrap().translation().x - 2.05).abs() < 1e-12);
    assert_eq!(names(&scene.check(&query())), [["cup", "wall"]]);
    scene.allow("wall", "cup").unwrap();
    let allowed = scene.check(&query());
    assert_eq!((allowed.verdict(), allowed.allowed, allowed.count), (Verdict::Free, 1, 3));
    scene.forbid("cup", "wall").unwrap();
    assert_eq!(scene.check(&query()).pairs.len(), 1);
    scene.remove("cup").unwrap();
    assert_eq!(scene.check(&query()).verdict(), Verdict::Free);
}

#[test]
fn what_cannot_be_meant_is_refused_with_names_and_leaves_the_scene_as_it_was() {
    let cube = Arc::new(mesh(&scene::cuboid([0.1; 3])));
    let here = at(0.0, 0.0, 0.0);
    let mut scene = Scene::default();
    for name in ["arm", "hand", "cup"] {
        scene.add(name, Arc::clone(&cube), here).unwrap();
    }
    scene.attach("hand", "arm", here).unwrap();
    scene.attach("cup", "hand", here).unwrap();
    let nowhere = at(f64::NAN, 0.0, 0.0);
    let unknown = |error| matches!(error, Err(SceneError::UnknownName { name }) if name == "mug");
    assert!(matches!(
        scene.add("cup", Arc::clone(&cube), here), Err(SceneError::NameTaken { name }) if name == "cup"
    ));
    assert!(matches!(
        scene.add("mug", Arc::clone(&cube), nowhere), Err(SceneError::Pose { value, .. }) if value.is_nan()
    ));
    assert!(matches!(
        scene.set_pose("cup", at(1e11, 0.0, 0.0)),
        Err(SceneError::Pose { value: 1e11, .. })
    ));
    assert!(unknown(scene.set_pose("mug", here)));
    assert!(unknown(scene.attach("cup", "mug", here)) && unknown(scene.allow("cup", "mug")));
    assert!(unknown(scene.replace("mug", Arc::clone(&cube)).map(|_| ())));
    for (name, to) in [("arm", "cup"), ("arm", "hand"), ("arm", "arm")] {
        let circle = scene.attach(name, to, here);
        assert!(matches!(circle, Err(SceneError::Circle { .. })), "{name} to {to}");
    }
    let held = scene.remove("hand").map(|_| ());
    assert_eq!(held, Err(SceneError::HoldsOthers { name: "hand".into(), attached: "cup".into() }));
    assert_eq!(scene.detach("arm"), Err(SceneError::NotAttached { name: "arm".into() }));
    assert_eq!(scene.allow("arm", "arm"), Err(SceneError::OneBody { name: "arm".into() }));
    assert_eq!(scene.body_mut("arm").map(|_| ()), Err(SceneError::Shared { name: "arm".into() }));
    assert_eq!(scene.names().collect::<Vec<_>>(), ["arm", "cup", "hand"]);
    scene.remove("cup").unwrap();
    let again = scene.remove("cup").map(|_| ());
    assert_eq!(again, Err(SceneError::UnknownName { name: "cup".into() }));
    scene.remove("hand").unwrap();
}

#[test]
fn a_cloud_in_the_scene_can_be_changed_and_replaced() {
    let mut scene = Scene::default();
    let ball = scene::sphere(0.05, 2);
    scene.add("ball", cloud(&ball, 0.01, 0.001, 1), at(0.0, 0.0, 0.0)).unwrap();
    scene.add("cube", mesh(&scene::cuboid([0.1; 3])), at(0.3, 0.0, 0.0)).unwrap();
    assert_eq!(scene.check(&query()).verdict(), Verdict::Free);
    let Body::Cloud(held) = scene.body_mut("ball").unwrap() else { panic!("a cloud was added") };
    let beside = measured(&scene::moved(&ball, &at(0.25, 0.0, 0.0)), 0.01, 0.001, 2);
    let by = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    held.insert(&PointCloud::from_points(beside), &by).unwrap();
    assert_eq!(names(&scene.check(&query())), [["ball", "cube"]]);
    let old = scene.replace("ball", cloud(&ball, 0.01, 0.001, 3)).unwrap();
    assert!(matches!(&*old, Body::Cloud(_)));
    assert_eq!(scene.check(&query()).verdict(), Verdict::Free);
}
