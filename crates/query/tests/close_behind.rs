//! What a camera did not see close behind a surface that it met is rather inside the thing than in its shadow.

use std::f64::consts::FRAC_PI_2;

use crate::common::{at, mesh};
use cloudtouch::geom::{PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, Query, QuerySettings, Report, Safeguards, Undecided, Verdict, Warning,
};
use cloudtouch_testkit::camera::DepthCamera;
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::scene;

const BLOCK: f64 = 0.2;
const PLATE: f64 = 0.24;
const PEG: f64 = 0.008;

/// A block with its front 80 cm ahead of a level camera, which sees nothing else of it, before a wall.
fn view() -> PointCloud {
    let block = scene::moved(&scene::cuboid([BLOCK; 3]), &at(0.0, 0.0, 0.8 + 0.5 * BLOCK));
    let wall = scene::moved(&scene::plane_patch(6.0), &at(0.0, 0.0, 2.0));
    let [block, wall] = [block, wall].map(|part| ExactMesh::new(&part));
    DepthCamera::default().scan(&[&block, &wall], &Pose::identity(), 5)
}

/// A plate with a peg under it that is so long, m; `y` of a camera points down.
fn tool(peg: f64) -> TriangleMesh {
    let plate = scene::cuboid([PLATE, 0.01, PLATE]);
    let peg = scene::moved(&scene::cuboid([PEG, peg, PEG]), &at(0.0, 0.5 * peg, 0.0));
    scene::assemble([plate, peg])
}

/// With the plate so far above the block and its peg so far behind the front of it, m.
fn ask(safeguards: Safeguards, peg: f64, above: f64, behind: f64) -> Report {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    let cloud = Cloud::prepare(&view(), &settings).expect("a good image");
    let query = Query::new(QuerySettings { safeguards, ..QuerySettings::default() });
    let pose = at(0.0, -0.5 * BLOCK - above, 0.8 + behind);
    query.expect("good settings").run(&cloud, &mesh(&tool(peg)), &pose).expect("an answer")
}

/// A peg through the unseen top of a block, less than 2 % of its tool: it read `free`.
#[test]
fn a_peg_in_the_block_behind_its_front_is_undecided() {
    let report = ask(Safeguards::default(), 0.09, 0.05, 0.02);
    let unseen = report.unseen.expect("an image");
    assert!(unseen.share() < Safeguards::default().max_unseen, "{unseen:?}");
    assert!(unseen.close_behind > 0.003, "{unseen:?}");
    assert_eq!(report.undecided_by, Some(Undecided::Unseen), "{report:?}");
    let warning = report.warnings.iter().find(|w| matches!(w, Warning::CloseBehind { .. }));
    assert!(warning.is_some_and(|w| w.to_string().contains("may be inside it")), "{report:?}");
    // Who takes the unseen for empty takes this for empty.
    let never = Safeguards { max_unseen: 1.0, ..Safeguards::default() };
    assert_eq!(ask(never, 0.09, 0.05, 0.02).verdict, Verdict::Free);
}

#[test]
fn a_peg_in_sight_or_deep_in_the_shadow_is_not_close_behind() {
    for (name, peg, above, behind, is_seen) in [
        ("above the block", 0.03, 0.05, 0.02, true),
        ("before its front", 0.09, 0.05, -0.02, true),
        ("far behind it, in its shadow", 0.14, 0.1, 0.35, false),
    ] {
        let report = ask(Safeguards::default(), peg, above, behind);
        let unseen = report.unseen.expect("an image");
        assert_eq!(unseen.close_behind, 0.0, "{name}");
        assert_eq!(unseen.behind_returns == 0.0, is_seen, "{name}: {unseen:?}");
        assert_eq!(report.verdict == Verdict::Free, is_seen, "{name}: {report:?}");
    }
}

/// At such an angle a cell of the image reaches over more of the table than the block is above it: what is behind its
/// nearest return counted as hidden, and a block 8 mm over the table was `undecided`.
#[test]
fn what_stands_over_a_table_seen_at_a_low_angle_is_not_behind_it() {
    let camera =
        Pose::from_translation_rpy(Vector3::new(-1.2, 0.0, 0.25), [-1.77, 0.0, -FRAC_PI_2]);
    let table = ExactMesh::new(&scene::plane_patch(3.0));
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.001 });
    let image = DepthCamera::default().scan(&[&table], &camera, 5);
    let cloud = Cloud::prepare(&image, &settings).expect("a good image");
    let query = Query::new(QuerySettings::default()).expect("good settings");
    let block = mesh(&scene::cuboid([0.1, 0.1, 0.1]));
    for along in [-0.2, 0.0, 0.2] {
        let pose = camera.inverse().after(&at(along, 0.0, 0.058));
        let report = query.run(&cloud, &block, &pose).expect("an answer");
        assert_eq!(report.unseen.expect("an image").behind_returns, 0.0, "{along}");
        assert_eq!(report.verdict, Verdict::Free, "{along}: {report:?}");
    }
}
