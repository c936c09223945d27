//! What the classifier is given in the paper's mode are the leaves of the tree, as its settings say.

use crate::common::{at, measured};
use cloudtouch::bvh::TreeSettings;
use cloudtouch::geom::PointCloud;
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    PaperCloud, PaperCloudSettings, PaperModel, PaperQuery, PaperSettings, bvh::Traversal,
};
use cloudtouch_testkit::scene;

/// How many leaf pairs a floor and a ball in overlap take, with trees split like this.
fn leaf_pairs(tree: TreeSettings) -> usize {
    let settings = PaperCloudSettings {
        model: PaperModel { tree, ..PaperModel::default() },
        ..PaperCloudSettings::new(SensorModel::Isotropic { std: 0.002 })
    };
    let cloud = |mesh, seed| {
        let points = measured(mesh, 0.015, 0.002, seed);
        PaperCloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
    };
    let (floor, ball) = (cloud(&scene::plane_patch(0.2), 1), cloud(&scene::sphere(0.05, 3), 2));
    let query = PaperQuery::new(PaperSettings {
        traversal: Traversal::Certified,
        stop_above: 1.0,
        ..PaperSettings::amended()
    });
    let report = query.expect("good settings").run(&floor, &ball, &at(0.0, 0.0, 0.045));
    report.expect("a finite pose").stats.leaf_pairs
}

/// Leaves of up to 40 points were taken together, whatever the tree was told.
#[test]
fn the_most_points_and_the_variation_of_a_leaf_were_without_effect() {
    let flat = TreeSettings { max_variation: 1.0 / 3.0, ..TreeSettings::default() };
    let few = |max_leaf_points| TreeSettings { max_leaf_points, min_leaf_points: 3, ..flat };
    let [small, middle, large] = [10, 20, 40].map(|most| leaf_pairs(few(most)));
    assert!(small > middle && middle > large, "{small}, {middle}, {large}");
    let curved = TreeSettings { min_leaf_points: 5, max_variation: 0.01, ..few(40) };
    let by_variation = leaf_pairs(curved);
    assert!(by_variation > large, "{by_variation} and {large}");
}
