//! A body that a depth camera sees in a space with surface all around.

use crate::common::{at, mesh};
use cloudtouch::geom::{Pose, TriangleMesh};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Undecided, Verdict};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

/// Where the bars are, and the wall behind the room, ahead of the camera, m.
const BARS: f64 = 0.6;
const BACK: f64 = 1.2;
/// From the middle of a bar to that of the next, m, and how wide one is.
const PITCH: f64 = 0.03;
const BAR: f64 = 0.012;

/// A room behind bars, which a camera before them sees all of.
fn room() -> Vec<TriangleMesh> {
    let (deep, middle) = (BACK - BARS, 0.5 * (BARS + BACK));
    let slab = |size, pose: Pose| scene::moved(&scene::cuboid(size), &pose);
    let sides = [-1.0, 1.0].map(|side| slab([0.02, 1.02, deep], at(0.67 * side, 0.0, middle)));
    let others = [-1.0, 1.0].map(|side| slab([1.36, 0.02, deep], at(0.0, 0.5 * side, middle)));
    let back = slab([1.36, 1.02, 0.02], at(0.0, 0.0, BACK));
    let bars =
        (-22..22).map(|k| slab([BAR, 1.0, 0.01], at((f64::from(k) + 0.5) * PITCH, 0.0, BARS)));
    sides.into_iter().chain(others).chain([back]).chain(bars).collect()
}

/// A single line from the camera passed bars too closely to tell, and the body was `undecided`, within the room or a
/// solid, though the image had all of it in sight.
#[test]
fn what_is_seen_between_bars_was_enclosed() {
    let parts: Vec<ExactMesh> = room().iter().map(ExactMesh::new).collect();
    let camera =
        DepthCamera { width: 320, height: 240, veil_probability: 0.0, ..DepthCamera::default() };
    let image = camera.scan(&parts.iter().collect::<Vec<_>>(), &Pose::identity(), 5);
    let settings = CloudSettings::new("kinect".parse::<SensorModel>().expect("a sensor"));
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let body = mesh(&scene::cuboid([0.02; 3]));
    let cloud = Cloud::prepare(&image, &settings).expect("a good image");
    for ahead in [0.75, 0.9, 1.1] {
        let report = query.run(&cloud, &body, &at(0.0, 0.0, ahead)).expect("a good pose");
        assert_eq!(report.verdict, Verdict::Free, "{ahead}: {report:?}");
    }
    // Without the rows and columns nothing tells.
    let points = image.select(&(0..image.len()).collect::<Vec<_>>());
    let cloud = Cloud::prepare(&points, &settings).expect("a good cloud");
    let report = query.run(&cloud, &body, &at(0.0, 0.0, 0.9)).expect("a good pose");
    assert_eq!(report.undecided_by, Some(Undecided::Enclosed), "{report:?}");
}
